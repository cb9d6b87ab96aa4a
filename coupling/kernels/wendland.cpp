// Wendland C2:   g(r) = (1 - q)^4 (1 + 4 q),   q = r/R,   R = sqrt(15) delta.
//
// As smooth as the Gaussian in practice, but it ends: a cell enters the support with weight zero, so that weights are continuous in time.
// R from delta: int_0^1 q^4 (1-q)^4 (1+4q) dq / int_0^1 q^2 (1-q)^4 (1+4q) dq = (1/210)/(1/42) = 1/5 = 3 delta^2/R^2.
// The mean of 1/|x - x'| is 2.148 1/R, by integration over pairs of shells.
// Source: Wendland (1995), Adv. Comput. Math. 4, 389-396.
#include <algorithm>
#include <cmath>

#include "coupling/distance_kernel.hpp"
#include "coupling/vector_math.hpp"

namespace snag {
namespace {

struct WendlandKernel final : DistanceKernel {
  static constexpr const char* name = "wendland";
  std::string equation() const override { return "g(r) = (1 - q)^4 (1 + 4 q), q = r/R, R = sqrt(15) delta"; }
  std::string source() const override { return "Wendland (1995)"; }
  double overlap() const override { return 0.98314; }
  double support_radius(double width) const override { return std::sqrt(15.0) * width; }
  void log_weights(std::span<double> distance_squared, double width) const override {
    const double R = support_radius(width);
    double* values = distance_squared.data();
#pragma omp simd
    for (std::size_t s = 0; s < distance_squared.size(); ++s) {
      const double q = std::min(std::sqrt(values[s]) / R, 1.0);  // round-off must not put it beyond 1
      values[s] = 4 * log(1 - q) + log(1 + 4 * q);
    }
  }
};
[[maybe_unused]] const bool registered = kernel_shapes().add<WendlandKernel>();

}  // namespace
}  // namespace snag
