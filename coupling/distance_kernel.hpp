#pragma once
// Kernels by distance: weight of particle b in cell c
//
//   w_bc = V_c d_c g(|x_c - x_b|) / sum_c' V_c' d_c' g(|x_c' - x_b|)
//
// with the factors d_c of cells at walls (coupling/kernel.hpp). The exponent of g is shifted by that of the nearest centre (log-sum-exp),
// so a kernel narrower than the cells becomes the nearest cell and nothing is ever 0/0. Where no centre lies in the support, the cell that
// holds the particle has weight 1.
#include <span>

#include "coupling/kernel_shape.hpp"

namespace snag {

class DistanceKernel : public KernelShape {
 public:
  /// Distance beyond which g is zero, m.
  virtual double support_radius(double width) const = 0;
  /// Replace squared distances (m2, all < support radius squared) by ln g, up to a constant that is the same for all calls.
  virtual void log_weights(std::span<double> distance_squared, double width) const = 0;

  double cells_reached(double width, double side) const override;
  std::unique_ptr<CellWeights> weights(double width, const Mesh& mesh, const CellLocator& locator) const override;
};

}  // namespace snag
