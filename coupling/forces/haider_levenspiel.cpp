// Drag of a particle of any compact shape, by its sphericity phi:
//
//   C_d = 24/Re (1 + A Re^B) + C/(1 + D/Re),   Re of the sphere of the same volume
//   A = exp(2.3288 - 6.4581 phi + 2.4486 phi^2)          B = 0.0964 + 0.5565 phi
//   C = exp(4.905 - 13.8944 phi + 18.4222 phi^2 - 10.2599 phi^3)
//   D = exp(1.4681 + 12.2584 phi - 20.7322 phi^2 + 15.8855 phi^3)
//
// Source: Haider and Levenspiel (1989), Powder Technol. 58, 63-70.
#include "coupling/sphere_drag.hpp"

namespace snag {
namespace {

struct HaiderLevenspiel final : ShapeDrag {
  static constexpr const char* name = "haider_levenspiel";

  ForceDescription description() const override {
    return {.name = name,
            .equation = "C_d = 24/Re (1 + A Re^B) + C/(1 + D/Re), A to D by sphericity",
            .source = "Haider and Levenspiel (1989)",
            .valid_for = "sphericity above 0.5, Re < 2.6e5",
            .role = Role::drag};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double f = sphericity, factor = drag_factor;
    const double A = std::exp(2.3288 + f * (-6.4581 + f * 2.4486)), B = 0.0964 + 0.5565 * f;
    const double C = std::exp(4.905 + f * (-13.8944 + f * (18.4222 - f * 10.2599)));
    const double D = std::exp(1.4681 + f * (12.2584 + f * (-20.7322 + f * 15.8855)));
    add_sphere_drag(fluid, particles, forces, [=](double Re) { return factor * (24 * (1 + A * pow(Re, B)) + C * Re * Re / (Re + D)); });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {drag_at(1e-7, 24e7, 1e-4, "Stokes (1851): F = 3 pi mu d w"),
            drag_at(100, 1.087, 0.07, "standard drag curve, Clift, Grace and Weber (1978)"),
            drag_at(1e5, 0.48, 0.1, "standard drag curve, Clift, Grace and Weber (1978)")};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<HaiderLevenspiel>();

}  // namespace
}  // namespace snag
