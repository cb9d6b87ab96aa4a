// The cell that holds the particle's centre has weight 1:   w_bc = 1 if x_b in c, else 0.
//
// Right where particles are much smaller than cells; jumps when a particle crosses a face, and what a particle feels depends on the cell
// size. Source: Jensen (2018) section 5.1.2.
#include "coupling/kernel_shape.hpp"

namespace snag {
namespace {

struct CellKernel final : KernelShape {
  static constexpr const char* name = "cell";
  std::string equation() const override { return "w_bc = 1 in the cell that holds the particle's centre"; }
  std::string source() const override { return "Jensen (2018) section 5.1.2"; }
  double support_radius(double) const override { return 0; }
  void log_weights(std::span<double>, double) const override {}
};
[[maybe_unused]] const bool registered = kernel_shapes().add<CellKernel>();

}  // namespace
}  // namespace snag
