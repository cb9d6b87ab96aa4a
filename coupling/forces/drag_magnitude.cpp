// Drag of another size:   F = (1 + theta) F_drag
//
// One factor on whatever drag law is active: particles that are rougher, larger or less round than the law takes them for.
#include "coupling/drag_modifier.hpp"

namespace snag {
namespace {

struct DragMagnitude final : FluidForce {
  static constexpr const char* name = "drag_magnitude";
  double excess = 0;

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = (1 + theta) F_drag",
            .source = "definition",
            .valid_for = "any drag law",
            .role = Role::drag_modifier,
            .prior = Prior{.key = "coupling.drag_magnitude.excess",
                           .meaning = "relative excess of drag",
                           .mean = 0.3,
                           .sd = 0.3,
                           .minimum = -0.9,
                           .maximum = 5}};
  }
  std::vector<Parameter> parameters() override {
    return {{"excess", &excess, "1", -0.9, 100, Basis::assumed, "Relative excess theta of the drag; 0: the drag law unchanged."}};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double f = 1 + excess;
    multiply_drag(fluid, particles, forces, [f](int, double, double) { return f; });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    auto reference = drag_at(100, (1 + excess) * 1.087, 0.02, "standard drag curve, Clift, Grace and Weber (1978)");
    return {reference};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<DragMagnitude>();

}  // namespace
}  // namespace snag
