// Drag with another dependence on velocity:   C_d -> C_d (max(Re, 1)/Re_ref)^theta,   Re = rho |w| d/mu
//
// Below Re = 1, where drag is linear whatever the body, the factor stays what it is at Re = 1, so that it is finite at rest.
#include <algorithm>

#include "coupling/drag_modifier.hpp"

namespace snag {
namespace {

constexpr double least_reynolds = 1;

struct DragExponent final : FluidForce {
  static constexpr const char* name = "drag_exponent";
  double exponent = 0, reference_reynolds = 100;

  ForceDescription description() const override {
    return {.name = name,
            .equation = "C_d -> C_d (max(Re, 1)/Re_ref)^theta",
            .source = "power law about a reference state",
            .valid_for = "any drag law",
            .role = Role::drag_modifier,
            .prior = Prior{.key = "coupling.drag_exponent.exponent",
                           .meaning = "change of the exponent of Re in the drag coefficient",
                           .mean = 0.2,
                           .sd = 0.2,
                           .minimum = -1,
                           .maximum = 1}};
  }
  std::vector<Parameter> parameters() override {
    return {
        {"exponent", &exponent, "1", -1, 1, Basis::assumed, "Exponent theta of the factor on C_d; 0: the drag law unchanged."},
        {"reference_reynolds", &reference_reynolds, "1", 1e-6, 1e7, Basis::assumed, "Re_ref: Reynolds number at which the factor is 1."}};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (exponent == 0) return;  // a power of zero is 1 only to the last digits
    const double theta = exponent, per_reference = 1 / reference_reynolds;
    multiply_drag(fluid, particles, forces,
                  [=](int, double Re, double) { return pow(per_reference * std::max(Re, least_reynolds), theta); });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {drag_at(100, 1.087, 0.02, "standard drag curve, Clift, Grace and Weber (1978), at the reference state")};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<DragExponent>();

}  // namespace
}  // namespace snag
