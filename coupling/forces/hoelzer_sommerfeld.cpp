// Drag of a particle of any shape and orientation, by sphericities:
//
//   C_d = 8/Re phi_l^(-1/2) + 16/Re phi^(-1/2) + 3 Re^(-1/2) phi^(-3/4) + 0.42 * 10^(0.4 (-log10 phi)^0.2) / phi_c
//
// phi_l: lengthwise sphericity (cross-section of the sphere of the same volume over the difference of half the surface and the mean
// longitudinal projected area), phi_c: crosswise sphericity (that cross-section over the projected area). All 1 for a sphere.
// Source: Hoelzer and Sommerfeld (2008), Powder Technol. 184, 361-365, Eq. 10.
#include "coupling/sphere_drag.hpp"

namespace snag {
namespace {

struct HoelzerSommerfeld final : ShapeDrag {
  static constexpr const char* name = "hoelzer_sommerfeld";
  double lengthwise_sphericity = 1, crosswise_sphericity = 1;

  ForceDescription description() const override {
    return {.name = name,
            .equation = "C_d = 8/Re phi_l^(-1/2) + 16/Re phi^(-1/2) + 3 Re^(-1/2) phi^(-3/4) + 0.42 10^(0.4 (-log10 phi)^0.2)/phi_c",
            .source = "Hoelzer and Sommerfeld (2008)",
            .valid_for = "any shape, Re < 1e5; 14 % mean deviation",
            .role = Role::drag};
  }
  std::vector<Parameter> parameters() override {
    auto records = ShapeDrag::parameters();
    records.push_back(
        {"lengthwise_sphericity", &lengthwise_sphericity, "1", 0.05, 20, Basis::assumed, "phi_l: sphericity lengthwise to the flow."});
    records.push_back(
        {"crosswise_sphericity", &crosswise_sphericity, "1", 0.05, 20, Basis::assumed, "phi_c: sphericity crosswise to the flow."});
    return records;
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double viscous = 8 / std::sqrt(lengthwise_sphericity) + 16 / std::sqrt(sphericity), between = 3 * std::pow(sphericity, -0.75);
    const double newton = 0.42 * std::pow(10, 0.4 * std::pow(-std::log10(sphericity), 0.2)) / crosswise_sphericity;
    const double factor = drag_factor;
    add_sphere_drag(fluid, particles, forces, [=](double Re) { return factor * (viscous + between * std::sqrt(Re) + newton * Re); });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {drag_at(1e-8, 24e8, 1e-4, "Stokes (1851): F = 3 pi mu d w"),
            drag_at(100, 1.087, 0.14, "standard drag curve, Clift, Grace and Weber (1978)"),
            drag_at(1e5, 0.48, 0.14, "standard drag curve, Clift, Grace and Weber (1978)")};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<HoelzerSommerfeld>();

}  // namespace
}  // namespace snag
