// Hindrance by the solids around:   F = epsilon^(-theta) F_drag,   epsilon = 1 - solid fraction at the particle
//
//   form "power"    epsilon^(-theta)
//   form "linear"   1 + theta (1 - epsilon): its leading order
//
// It multiplies a drag law of single spheres by the slip w = u - v, u the velocity of the mixture, as in coupling/suspension_drag.hpp. A
// suspension that settles in water without a net flow then has v = v_single epsilon^n, theta = n in creeping flow. (Published exponents of
// about 2.7 are for the slip in the gaps and for the drag beside the pressure gradient of the mixture: 2 less.)
// Source: Richardson and Zaki (1954), Trans. Inst. Chem. Eng. 32, 35-53: n = 4.65; di Felice (1994), Int. J. Multiphase Flow 20, 153-159:
// 4.7 in creeping and in fast flow, 4.05 at least.
#include <algorithm>

#include "coupling/drag_modifier.hpp"
#include "coupling/suspension_drag.hpp"

namespace snag {
namespace {

struct VolumeFraction final : FluidForce {
  static constexpr const char* name = "volume_fraction";
  double exponent = 4.7;
  enum class Form { power, linear };
  Choice<Form> form{Form::power, {"power", "linear"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = epsilon^(-theta) F_drag",
            .source = "Richardson and Zaki (1954), di Felice (1994)",
            .valid_for = "many particles, void fraction above 0.4",
            .samples = {.solid_fraction = true},
            .role = Role::drag_modifier,
            .prior = Prior{.key = "coupling.volume_fraction.exponent",
                           .meaning = "exponent of the void fraction in the drag",
                           .mean = 4.7,
                           .sd = 1.3,
                           .minimum = 0,
                           .maximum = 10,
                           .acts_on_water = true,
                           .needs = {Need::solid_fraction, Need::several}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"exponent", &exponent, "1", 0, 10, Basis::literature, "Exponent theta; 0: drag of single particles."},
            setting("form", &form, "power: of the void fraction; linear: its leading order.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (exponent == 0) return;  // a power of zero is 1 only to the last digits
    const double theta = exponent;
    const bool power = form == Form::power;
    const double* solid = fluid.solid_fraction;
    multiply_drag(fluid, particles, forces, [=](int p, double, double) {
      const double grown = pow(void_fraction(solid[p]), -theta);
      return power ? grown : 1 + theta * solid[p];
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    auto dense = stokes_limit();
    dense.what = "suspension of a fifth solids in creeping flow";
    dense.source = "Richardson and Zaki (1954): hindered settling with n = 4.65 to 4.8, F ~ epsilon^(-n)";
    dense.state.solid_fraction = 0.2;
    dense.force = std::pow(0.8, -4.7) * dense.force, dense.tolerance = 0.02;
    return {dense};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<VolumeFraction>();

}  // namespace
}  // namespace snag
