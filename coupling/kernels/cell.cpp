// The cell that holds the particle's centre has weight 1:   w_bc = 1 if x_b in c, else 0.
//
// Right where particles are much smaller than cells; jumps when a particle crosses a face, and what a particle feels depends on the cell
// size. Source: Jensen (2018) section 5.1.2.
#include "coupling/point_kernel.hpp"

namespace snag {
namespace {

struct CellKernel final : PointKernel {
  static constexpr const char* name = "cell";
  std::string equation() const override { return "w_bc = 1 in the cell that holds the particle's centre"; }
  std::string source() const override { return "Jensen (2018) section 5.1.2"; }
  bool has_width() const override { return false; }
  double overlap() const override { return 1; }
  std::vector<Vec3> points(double) const override { return {Vec3{}}; }
};
[[maybe_unused]] const bool registered = kernel_shapes().add<CellKernel>();

}  // namespace
}  // namespace snag
