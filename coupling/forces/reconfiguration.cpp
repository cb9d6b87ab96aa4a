// Flexible parts that the particles do not resolve (threads, edges, fluff) fold in a fast flow:
//
//   form "cauchy"   F = (1 + (|w|/w_0)^2)^(V/2) F_drag          rigid below w_0, F ~ |w|^(2 + V) above
//   form "power"    F = max(|w|/w_0, 1)^V F_drag                the same with a corner
//
// V: Vogel exponent, theta; 0 rigid, -2/3 a sheet that bends in two dimensions, about -1 crumpling cones and leaves.
// Source: Vogel (1984), Am. Zool. 24, 37-44; Alben, Shelley and Zhang (2002), Nature 420, 479-481; Gosselin, de Langre and
// Machado-Almeida (2010), J. Fluid Mech. 650, 319-341.
#include <algorithm>

#include "coupling/drag_modifier.hpp"

namespace snag {
namespace {

struct Reconfiguration final : FluidForce {
  static constexpr const char* name = "reconfiguration";
  double exponent = -2.0 / 3, reference_speed = 0.5;
  enum class Form { cauchy, power };
  Choice<Form> form{Form::cauchy, {"cauchy", "power"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = (1 + (|w|/w_0)^2)^(V/2) F_drag",
            .source = "Vogel (1984); Gosselin, de Langre and Machado-Almeida (2010)",
            .valid_for = "flexible parts below the resolution of the particles",
            .role = Role::drag_modifier,
            .prior = Prior{.key = "coupling.reconfiguration.exponent",
                           .meaning = "Vogel exponent",
                           .mean = -0.67,
                           .sd = 0.33,
                           .minimum = -2,
                           .maximum = 0,
                           .needs = {Need::bonds}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"exponent", &exponent, "1", -2, 0, Basis::literature, "Vogel exponent V (theta); 0: rigid parts."},
            {"reference_speed", &reference_speed, "m/s", 1e-6, 100, Basis::assumed, "w_0: relative speed above which the parts fold."},
            setting("form", &form, "cauchy: smooth; power: with a corner at w_0.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (exponent == 0) return;  // a power of zero is 1 only to the last digits
    const double V = exponent, per_reference = 1 / reference_speed;
    const bool smooth = form == Form::cauchy;
    multiply_drag(fluid, particles, forces, [=](int, double, double speed) {
      const double x = per_reference * speed, square = smooth ? 1 + x * x : std::max(x * x, 1.0);
      return pow(square, 0.5 * V);
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    auto slow = stokes_limit();
    slow.what = "far below the reference speed: rigid";
    return {slow};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Reconfiguration>();

}  // namespace
}  // namespace snag
