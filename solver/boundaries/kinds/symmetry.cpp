// Plane of symmetry, or a wall that the fluid slips along:   (u - u_w).n = 0,   no friction,   dp/dn = - rho a.n
// u_w: of a face that turns with the turning zone, else 0; a: the share of its acceleration that the water has (solver/continuity.cpp)
#include "solver/boundaries/turning_wall.hpp"

namespace snag {
namespace {

struct Symmetry final : Boundary {
  static constexpr const char* name = "symmetry";

  Section section() override { return {.name = name, .meaning = "Plane of symmetry or slip wall.", .parameters = {}}; }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::normal_velocity; }
  void update(const Flow& flow, const Patch& patch, double time, BoundaryValues& values) const override {
    set_wall_of_zone(false, flow, patch, time, values);
  }
};
const bool registered = boundaries().add<Symmetry>();

}  // namespace
}  // namespace snag
