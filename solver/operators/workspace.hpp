#pragma once
// What the equations of a step share: moments for gradients, and arrays that they use in turn. Momentum, pressure, turbulence: each of them
// finds in these arrays what the last one left behind, fills what it needs, and is done with it when the next one begins.
#include <array>
#include <vector>

#include "base/room.hpp"
#include "mesh/mesh.hpp"
#include "solver/operators/cell_matrix.hpp"
#include "solver/operators/gradient.hpp"

namespace snag {

struct Workspace {
  explicit Workspace(const Mesh& mesh) : moments(mesh), matrix(mesh), face(static_cast<std::size_t>(mesh.n_faces)) {
    for (auto& field : scalar) field.resize(static_cast<std::size_t>(mesh.n_all_cells()));
    for (auto& field : vector) field.resize(static_cast<std::size_t>(mesh.n_all_cells()));
  }
  /// Again after the facets of the mesh have changed. Local.
  void mesh_turned(const Mesh& mesh) {
    moments.update(), matrix.update(mesh);
    resize_with_room(face, static_cast<std::size_t>(mesh.n_faces));
  }

  CellMoments moments;
  // in turn
  CellMatrix matrix;
  std::array<std::vector<double>, 8> scalar;  // [n_all_cells]
  std::array<std::vector<Vec3>, 2> vector;    // [n_all_cells]
  std::vector<double> face;                   // [n_faces]
};

}  // namespace snag
