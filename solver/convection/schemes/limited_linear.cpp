// Linear interpolation, limited in each component by itself (solver/fields/face.hpp):
//
//   u_f^high = u_C + clamp(2 r, 0, 1) (1 - w_C) (u_D - u_C),   r = 2 (G_C d)/(u_D - u_C) - 1
//
// total variation diminishing in one dimension, within the bounds of Sweby (1984), SIAM J. Numer. Anal. 21, 995:
// the function of OpenFOAM's limitedLinear with the coefficient 1.
#include "solver/convection/face_scheme.hpp"

namespace snag {
namespace {

struct LimitedLinear final : FaceScheme<LimitedLinear> {
  static constexpr const char* name = "limited_linear";

  ConvectionDescription description() const override {
    return {"u_f interpolated linearly between C and D, limited by the ratio r of the slopes upwind and across the face, min(2 r, 1)",
            "Sweby 1984", 2};
  }
  bool is_bounded() const override { return true; }
  static Vec3 high_order_part(ConvectedVelocity velocity, int f, double F) {
    const Mesh& mesh = velocity.mesh;
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    const int C = F > 0 ? P : N, D = F > 0 ? N : P;
    const Vec3 change = velocity.u[D] - velocity.u[C], slope = (F > 0 ? 1.0 : -1.0) * (velocity.G[C] * mesh.delta[f]);
    const double weight = F > 0 ? 1 - mesh.weight[f] : mesh.weight[f];
    return {limited_linear(change.x, slope.x, weight), limited_linear(change.y, slope.y, weight),
            limited_linear(change.z, slope.z, weight)};
  }
};
const bool registered = convection_schemes().add<LimitedLinear>();

}  // namespace
}  // namespace snag
