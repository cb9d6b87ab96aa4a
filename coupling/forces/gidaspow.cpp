// Drag in a suspension by Wen and Yu, in a packed bed by Ergun, with a smooth passage: F = (1 - s) K_e w + s K_w w,
// with the solid fraction 1 - epsilon at the particle (0.9 at most), w the slip in the gaps, Re = rho |w| d/mu, V = pi d^3/6:
//
//   Wen and Yu:  K_w = 3/4 V (rho |w|/d) C_d(Re_s) epsilon^(-1.65),   Re_s = epsilon Re,   C_d of Schiller and Naumann
//   Ergun:       K_e = V (150 (1 - epsilon) mu/(epsilon d^2) + 1.75 rho |w|/d)
//
//   s = 1/2 + arctan(150 * 1.75 (epsilon - 0.8))/pi
// Source: Gidaspow (1994), Multiphase Flow and Fluidization; passage of Huilin and Gidaspow (2003), Chem. Eng. Sci. 58, 3777-3792.
#include "coupling/sphere_drag.hpp"
#include "coupling/void_fraction.hpp"

namespace snag {
namespace {

struct Gidaspow final : FluidForce {
  static constexpr const char* name = "gidaspow";
  double drag_factor = 1;

  Card card() const override {
    return {.name = name,
            .equation = "F = ((1 - s) K_Ergun + s K_WenYu) w, s = 1/2 + arctan(262.5 (epsilon - 0.8))/pi",
            .source = "Gidaspow (1994), Huilin and Gidaspow (2003)",
            .valid_for = "spheres, all Re; solid fraction of a computed flow",
            .samples = {.solid_fraction = true},
            .role = Role::drag};
  }
  std::vector<Parameter> parameters() override {
    return {{"drag_factor", &drag_factor, "1", 0, 10, Basis::assumed, "Multiplies C_d; a particle of a rag is not an isolated sphere."}};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double factor = drag_factor;
    const double* solid = fluid.solid_fraction;
    add_sphere_drag(fluid, particles, forces, [=](double Re, int p) {
      const double epsilon = void_fraction(solid[p]), Re_s = epsilon * Re;
      const double in_newton = Re_s >= 1000 ? 1 : 0, viscous = 24 * (1 + 0.15 * pow(Re_s, 0.687));
      const double wen_yu = (viscous + in_newton * (0.44 * Re_s - viscous)) * pow(epsilon, -2.65);
      const double ergun = 4.0 / 3 * (150 * (1 - epsilon) / epsilon + 1.75 * Re);
      const double s = 0.5 + std::atan(150 * 1.75 * (epsilon - 0.8)) / std::numbers::pi;
      return factor * (ergun + s * (wen_yu - ergun));
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    SphereState packed = stokes_limit().state;
    packed.solid_fraction = 0.6;
    // Pressure drop of a packed bed 150 mu U (1 - epsilon)^2/(epsilon^3 d^2), U = epsilon w; of it epsilon V/(1 - epsilon) on a particle.
    const double over_stokes = 150.0 / 18 * 0.6 / 0.4;
    return {drag_at(1e-6, 24e6, 0.01, "Stokes (1851); the passage leaves 0.6 % of Ergun's law"),
            drag_at(100, 1.087, 0.02, "standard drag curve, Clift, Grace and Weber (1978)"),
            {.what = "packed bed in creeping flow",
             .source = "Ergun (1952)",
             .state = packed,
             .force = over_stokes * stokes_limit().force,
             .tolerance = 0.05}};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Gidaspow>();

}  // namespace
}  // namespace snag
