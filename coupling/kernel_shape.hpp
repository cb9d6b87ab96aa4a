#pragma once
// Smoothing kernels: how far the water around a particle counts. One kernel, one file in coupling/kernels/. A kernel finds and weighs cells
// in one of three manners (coupling/cell_weights.hpp): by the distance of their centres, at points about the particle, by diffusion through
// the faces. Normalisation, walls and transfers between ranks are the same for all of them (coupling/kernel.hpp).
#include <memory>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "base/registry.hpp"
#include "mesh/locator.hpp"

namespace snag {

class CellWeights;

/// On cells of side h a steady force in one cell answers there with 0.114/(mu h) for small steps to 0.129/(mu h) for large ones (mean over
/// the wave numbers of the grid of the discrete Stokes flow, with the balance of solver/continuity.hpp), as a Gaussian of this width does.
inline double width_of_cell(double side) { return 0.25 * side; }

/// `width` delta is for every kernel the rms width per axis in m, so that kernels can be compared: delta^2 = int x^2 g dV / int g dV.
class KernelShape {
 public:
  virtual ~KernelShape() = default;
  virtual std::string equation() const = 0;
  virtual std::string source() const = 0;
  virtual std::vector<Parameter> parameters() { return {}; }
  /// False: the weights are the same whatever the width.
  virtual bool has_width() const { return true; }
  /// q = sqrt(pi) delta <1/|x - x'|>, the mean over two places x, x' that are spread as g: 1 for a Gaussian. What a particle or a flat
  /// sheet spreads and averages back is that of a Gaussian of width delta/q.
  virtual double overlap() const = 0;
  /// Inverse width that the average holds of the flow about the particle's own force on cells of this side, beyond what the kernel's
  /// smooth shape g holds, 1/m: of points that lie apart.
  virtual double point_disturbance(double /*width*/, double /*side*/) const { return 0; }
  /// Cells of this side that get a share of a particle, about.
  virtual double cells_reached(double width, double side) const = 0;
  /// Width over the size of cells above which cells within the kernel get nothing.
  virtual double largest_width_over_cell() const { return infinity; }
  /// `mesh` and `locator` must outlive the weights.
  virtual std::unique_ptr<CellWeights> weights(double width, const Mesh& mesh, const CellLocator& locator) const = 0;

  /// delta/q, m; 0 without a width.
  double overlap_width(double width) const { return has_width() ? width / overlap() : 0; }
  /// Width of the Gaussian whose average over itself holds as much of the flow about its own force as g on cells of this side, m.
  double disturbance_width(double width, double side) const;
};

Registry<KernelShape>& kernel_shapes();

}  // namespace snag
