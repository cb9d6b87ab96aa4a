#pragma once
// Mean of the velocity gradient over the neighbours of a cell. Velocities at faces are corrected for skewness with it:
//
//   G-_P = sum_f share G_N / sum_f share        share: of a facet in its face, 1 of other faces
//
// Exact for linear fields, as G is, and of the same order. solver/fields/face.hpp says why it is not G itself. A cell without a neighbour
// has its own.
#include <array>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

class MeanGradient {
 public:
  /// `rows`: where the rows of it go, three fields over all cells, which the caller keeps.
  explicit MeanGradient(std::array<std::vector<Vec3>, 3>& rows) : row_(rows) {}
  /// Of G, [n_all_cells], 1/s. Collective.
  void set(const Mesh& mesh, std::span<const Mat3> G);
  /// The same at the cells of a zone and those at facets: others have what was there. Collective.
  void set_where_faces_turn(const Mesh& mesh, std::span<const Mat3> G, int zone);
  /// [u]_f.S of an interior face, m3/s, that a vector s from the line of centres adds, by the mean between both cells.
  double flux(const Mesh& mesh, int f, const Vec3& s) const {
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    const Vec3 &S = mesh.face_vector[f], along_P = mesh.weight[f] * s, along_N = (1 - mesh.weight[f]) * s;
    return S.x * (dot(row_[0][P], along_P) + dot(row_[0][N], along_N)) + S.y * (dot(row_[1][P], along_P) + dot(row_[1][N], along_N)) +
           S.z * (dot(row_[2][P], along_P) + dot(row_[2][N], along_N));
  }

 private:
  void set_cell(const Mesh& mesh, std::span<const Mat3> G, int c);
  std::array<std::vector<Vec3>, 3>& row_;
};

}  // namespace snag
