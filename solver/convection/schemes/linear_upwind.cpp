// Linear reconstruction in the upwind cell:   u_f^high = u_C + psi G_C (x_f - x_C)        psi: limiter, for each component by itself
// Source: Barth and Jespersen (1989), AIAA paper 89-0366.
#include "solver/convection/face_scheme.hpp"

namespace snag {
namespace {

struct LinearUpwind final : FaceScheme<LinearUpwind> {
  static constexpr const char* name = "linear_upwind";

  ConvectionDescription description() const override {
    return {"u_f = u_C + psi grad u_C . (x_f - x_C) with the factor psi of the `limiter`", "Barth and Jespersen 1989", 2};
  }
  bool is_limited() const override { return true; }
  bool is_bounded() const override { return true; }
  static Vec3 high_order_part(ConvectedVelocity velocity, int f, double F) {
    const Mesh& mesh = velocity.mesh;
    const auto [C, to_centre] = upwind(mesh, f, F);
    const Vec3 way = mesh.face_centre[f] - mesh.cell_centre[mesh.owner[f]] - to_centre * mesh.delta[f];
    return scaled(velocity.psi[C], velocity.G[C] * way);
  }
};
const bool registered = convection_schemes().add<LinearUpwind>();

}  // namespace
}  // namespace snag
