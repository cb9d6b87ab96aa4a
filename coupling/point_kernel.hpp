#pragma once
// Kernels at points: n points about the particle share its weight, each counts in the cell that holds it:
//
//   w_bc = sum_k [x_b + r_k in c] d_c / sum_c' sum_k [x_b + r_k in c'] d_c'
//
// with the factors d_c of cells at walls (coupling/kernel.hpp). What points outside the mesh would carry the others carry; they are
// counted. A point that two cells claim (on an edge between ranks, in a sliver at a sliding interface) goes to the lower cell_id.
#include "base/vec3.hpp"
#include "coupling/kernel_shape.hpp"

namespace snag {

class PointKernel : public KernelShape {
 public:
  /// r_k, m. The first is zero: the particle's centre.
  virtual std::vector<Vec3> points(double width) const = 0;

  double cells_reached(double width, double) const override { return static_cast<double>(points(width).size()); }
  std::unique_ptr<CellWeights> weights(double width, const Mesh& mesh, const CellLocator& locator) const override;
};

}  // namespace snag
