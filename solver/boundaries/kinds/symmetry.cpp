// Plane of symmetry, or a wall that the fluid slips along:   u.n = 0,   no friction,   dp/dn = 0
#include "solver/boundaries/boundary.hpp"

namespace snag {
namespace {

struct Symmetry final : Boundary {
  static constexpr const char* name = "symmetry";

  Section section() override { return {.name = name, .meaning = "Plane of symmetry or slip wall.", .parameters = {}}; }
  PrescribedQuantity fixes() const override { return PrescribedQuantity::normal_velocity; }
  void update(const Flow&, const Patch&, double, BoundaryValues&) const override {}
};
const bool registered = boundaries().add<Symmetry>();

}  // namespace
}  // namespace snag
