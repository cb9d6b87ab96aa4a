// Outlet with a given static pressure:
//
//   p = p_out,   du/dn = 0;      where fluid enters instead, it comes along the normal:   u = (flux/|S|) n
#include "solver/boundary.hpp"

namespace snag {
namespace {

struct PressureOutlet final : Boundary {
  static constexpr const char* name = "pressure_outlet";
  double pressure = 0;

  Section section() override {
    return {.name = name,
            .meaning = "Static pressure; fluid leaves with zero normal gradient and enters along the normal.",
            .parameters = {{"pressure", &pressure, "Pa", -infinity, infinity, Basis::assumed, "Static pressure, relative."}}};
  }
  Fixes fixes() const override { return Fixes::pressure; }
  void update(const Flow& flow, const Patch& patch, double, BoundaryValues& values) const override {
    for (int f = patch.first; f < patch.end(); ++f) values.pressure[f - flow.mesh.n_interior] = pressure;
  }
};
const bool registered = boundaries().add<PressureOutlet>();

}  // namespace
}  // namespace snag
