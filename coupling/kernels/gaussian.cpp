// Gaussian:   g(r) = exp(-r^2 / (2 delta^2)),   cut at r = 4 delta, where g is 3e-4 of its peak (the cut takes 0.5 % off the width).
//
// Source: Capecelatro and Desjardins (2013), J. Comput. Phys. 238, 1-31.
#include "coupling/distance_kernel.hpp"

namespace snag {
namespace {

struct GaussianKernel final : DistanceKernel {
  static constexpr const char* name = "gaussian";
  static constexpr double cut = 4;  // in widths
  std::string equation() const override { return "g(r) = exp(-r^2 / (2 delta^2)), r < 4 delta"; }
  std::string source() const override { return "Capecelatro and Desjardins (2013)"; }
  double overlap() const override { return 1; }
  double support_radius(double width) const override { return cut * width; }
  void log_weights(std::span<double> distance_squared, double width) const override {
    const double factor = -0.5 / (width * width);
    for (double& value : distance_squared) value *= factor;
  }
};
[[maybe_unused]] const bool registered = kernel_shapes().add<GaussianKernel>();

}  // namespace
}  // namespace snag
