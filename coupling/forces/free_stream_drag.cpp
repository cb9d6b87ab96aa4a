// Drag of the free stream on a sphere:   F = 1/2 rho C_d A |w| w,   w = u_fluid - v_particle,   Re = rho |w| d / mu
//   C_d = 24/Re                          Re <= 0.5
//         24/Re (1 + 0.15 Re^0.687)      0.5 < Re <= 1000      (9 % above the Stokes branch at Re = 0.5, as published)
//         0.44                           Re > 1000
// Source: Jensen (2018) Eq. 5.1, after Schiller and Naumann (1933).
#include "coupling/sphere_drag.hpp"

namespace snag {
namespace {

struct FreeStreamDrag final : SphereDrag {
  static constexpr const char* name = "free_stream_drag";

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = 1/2 rho C_d A |w| w; C_d = 24/Re (Re <= 0.5), 24/Re (1 + 0.15 Re^0.687) (Re <= 1000), 0.44",
            .source = "Jensen (2018) Eq. 5.1",
            .valid_for = "isolated sphere, Re < 2e5",
            .role = Role::drag};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double factor = drag_factor;
    add_sphere_drag(fluid, particles, forces, [factor](double Re) {
      // Branches chosen by arithmetic: a conditional call of pow would keep the loop from vectorising.
      const double in_transition = Re > 0.5 ? 1 : 0, in_newton = Re > 1000 ? 1 : 0;
      const double viscous = 24 * (1 + in_transition * 0.15 * pow(Re, 0.687));
      return factor * (viscous + in_newton * (0.44 * Re - viscous));
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {stokes_limit(), drag_at(144.5, 0.9204, 0.02, "IUP CalcDEMma, table drag07"),
            drag_at(1e4, 0.44, 1e-12, "Newton's range of Eq. 5.1")};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<FreeStreamDrag>();

}  // namespace
}  // namespace snag
