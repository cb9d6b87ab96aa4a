// Diffusion on the mesh:   w = V ((V + delta^2/(2 m) K)^(-1) V)^m V^(-1) e_h,   m = 4 implicit steps from the cell h that holds the
// particle (coupling/diffusion_weights.hpp)
//
// It sees walls and passes through none, and is joined across a sliding interface by its facets. As a cell does, it jumps when the particle
// crosses a face, by the smaller part the wider it is against the cells; it gives neighbours delta^2/(2 h^2) where it is narrower.
//
// Without walls one step of the time T = delta^2/m is a Gaussian of a random variance with the mean T; m steps have the distribution
// Gamma(m). The second moments are delta^2 for any m, the overlap of the kernel with itself is
//
//   q = (2 m)^(1/2) Gamma(2 m - 1/2)/Gamma(2 m) = 1.050       (a Gaussian: 1)
//
// Beyond the cut of 5 delta lie 1 % of the second moments.
// Source: Capecelatro and Desjardins (2013), J. Comput. Phys. 238, 1-31; Sun and Xiao (2015), Int. J. Multiphase Flow 72,
// 233-247.
#include <cmath>
#include <numbers>

#include "coupling/diffusion_weights.hpp"
#include "coupling/kernel_shape.hpp"

namespace snag {
namespace {

struct DiffusionKernel final : KernelShape {
  static constexpr const char* name = "diffusion";
  static constexpr int n_steps = 4;
  static constexpr double cut = 5;  // in widths
  std::string equation() const override {
    return "four implicit steps of diffusion from the cell that holds the particle, over the time delta^2/2";
  }
  std::string source() const override { return "Capecelatro and Desjardins (2013); Sun and Xiao (2015)"; }
  double overlap() const override { return std::sqrt(2.0 * n_steps) * std::tgamma(2 * n_steps - 0.5) / std::tgamma(2 * n_steps); }
  double cells_reached(double width, double side) const override { return 4.0 / 3.0 * std::numbers::pi * std::pow(cut * width / side, 3); }
  std::unique_ptr<CellWeights> weights(double width, const Mesh& mesh, const CellLocator&) const override {
    return std::make_unique<DiffusionWeights>(mesh, width * width / (2 * n_steps), n_steps, cut * width);
  }
};
[[maybe_unused]] const bool registered = kernel_shapes().add<DiffusionKernel>();

}  // namespace
}  // namespace snag
