#pragma once
// What the equations of a step share: moments for gradients, and arrays that they use in turn. Momentum, pressure, turbulence: each of them
// finds in these arrays what the last one left behind, fills what it needs, and is done with it when the next one begins.
#include <array>
#include <span>
#include <vector>

#include "base/flat.hpp"
#include "base/room.hpp"
#include "mesh/mesh.hpp"
#include "solver/fields/mean_gradient.hpp"
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

  /// A scalar field in the place of a vector that is not in use: its part 0, 1 or 2; [n_all_cells].
  std::span<double> scalar_in(std::vector<Vec3>& unused, std::size_t part) {
    const std::size_t n = unused.size();
    return flat(unused).subspan(part * n, n);
  }

  /// A mean gradient in the place of the vectors.
  MeanGradient mean_gradient() { return MeanGradient(vector); }

  CellMoments moments;
  // in turn
  CellMatrix matrix;
  std::array<std::vector<double>, 3> scalar;  // [n_all_cells]
  std::array<std::vector<Vec3>, 3> vector;    // [n_all_cells]
  std::vector<double> face;                   // [n_faces]
};

}  // namespace snag
