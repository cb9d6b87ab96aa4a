// First-order upwind differences:   u_f^high = u_C
// Source: Courant, Isaacson and Rees (1952), Commun. Pure Appl. Math. 5, 243.
#include "solver/convection/face_scheme.hpp"

namespace snag {
namespace {

struct Upwind final : FaceScheme<Upwind> {
  static constexpr const char* name = "upwind";

  ConvectionDescription description() const override { return {"u_f = u_C", "Courant, Isaacson and Rees 1952", 1}; }
  bool is_bounded() const override { return true; }
  static Vec3 high_order_part(ConvectedVelocity, int, double) { return {}; }
};
const bool registered = convection_schemes().add<Upwind>();

}  // namespace
}  // namespace snag
