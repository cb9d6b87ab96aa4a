#pragma once
// Linear reconstruction in tetrahedra, which takes more cells than the four neighbours:
//
//   gradient:   1/(1 + n) (G_P + sum_f share G_N), the mean of the cell's and those of its n neighbours
//   range:      solver/convection/velocity_range.hpp
//
// With the least-squares gradient over the four faces alone its convection grows from round-off: a uniform stream does not stay one. Both
// are exact for linear fields; cells of other kinds take their own gradient and neighbours.
// Source: Haider, Croisille and Courbet (2009), Numer. Math. 113, 555: stability on tetrahedra asks for more than the face neighbours.
// Barth and Jespersen (1989), AIAA paper 89-0366: a range over the cells around.
#include <span>
#include <vector>

#include "solver/convection/velocity_range.hpp"
#include "solver/operators/gradient.hpp"

namespace snag {

class TetrahedronReconstruction {
 public:
  /// Collective.
  explicit TetrahedronReconstruction(const Mesh& mesh);
  /// Gradients for the reconstruction from G, [n_all_cells], ghosts filled; valid until the next call. G itself on a mesh without
  /// tetrahedra. Collective.
  const std::vector<Mat3>& gradient(const std::vector<Mat3>& G);
  /// Ranges of u, [n_all_cells], ghosts filled; valid until the next call. `sides` and `given`, [n_faces - n_interior]: velocities that the
  /// boundary gives. Collective.
  TetrahedronRanges ranges(std::span<const Vec3> u, const std::vector<Side>& sides, std::span<const Vec3> given);

 private:
  const Mesh& mesh_;
  bool anywhere_ = false;
  std::vector<std::uint8_t> is_tetrahedron_;  // [n_cells], four faces, a facet counts with its share
  std::vector<Mat3> gradient_;                // [n_all_cells] where there are tetrahedra
  std::vector<VelocityRange> near_;           // likewise
};

}  // namespace snag
