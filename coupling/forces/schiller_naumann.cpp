// Drag of a sphere:   F = 1/2 rho C_d A |w| w,   w = u_fluid - v_particle,   Re = rho |w| d / mu
//   C_d = 24/Re (1 + 0.15 Re^0.687)      Re < 1000
//         0.44                           Re >= 1000
// Continuous down to Re = 0, unlike the free-stream law with its Stokes branch.
// Source: Schiller and Naumann (1933), Z. Ver. Dtsch. Ing. 77, 318.
#include "coupling/sphere_drag.hpp"

namespace snag {
namespace {

struct SchillerNaumann final : SphereDrag {
  static constexpr const char* name = "schiller_naumann";

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = 1/2 rho C_d A |w| w; C_d = 24/Re (1 + 0.15 Re^0.687) (Re < 1000), 0.44",
            .source = "Schiller and Naumann (1933)",
            .valid_for = "isolated sphere, Re < 2e5",
            .role = Role::drag};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double factor = drag_factor;
    add_sphere_drag(fluid, particles, forces, [factor](double Re) {
      // Branches chosen by arithmetic: a conditional call of pow would keep the loop from vectorising.
      const double in_newton = Re >= 1000 ? 1 : 0;
      const double viscous = 24 * (1 + 0.15 * pow(Re, 0.687));
      return factor * (viscous + in_newton * (0.44 * Re - viscous));
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {stokes_limit(), drag_at(100, 1.087, 0.02, "standard drag curve, Clift, Grace and Weber (1978)"),
            drag_at(1e4, 0.44, 1e-12, "Newton's range")};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<SchillerNaumann>();

}  // namespace
}  // namespace snag
