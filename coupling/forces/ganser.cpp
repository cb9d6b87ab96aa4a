// Drag of a particle of any compact shape, by its sphericity phi, with shape factors of Stokes's and Newton's range:
//
//   C_d = 24/(Re K_1) (1 + 0.1118 X^0.6567) + 0.4305 K_2/(1 + 3305/X),   X = Re K_1 K_2
//   K_1 = 1/(1/3 + 2/3 phi^(-1/2)),   K_2 = 10^(1.8148 (-log10 phi)^0.5743)          (isometric shapes)
//
// With these constants C_d of a sphere is 26 % below the standard curve at Re = 100, and right at both ends: for spheres take another law.
// Source: Ganser (1993), Powder Technol. 77, 143-152.
#include "coupling/sphere_drag.hpp"

namespace snag {
namespace {

struct Ganser final : ShapeDrag {
  static constexpr const char* name = "ganser";

  ForceDescription description() const override {
    return {.name = name,
            .equation = "C_d = 24/(Re K_1) (1 + 0.1118 X^0.6567) + 0.4305 K_2/(1 + 3305/X), X = Re K_1 K_2",
            .source = "Ganser (1993)",
            .valid_for = "isometric particles, Re K_1 K_2 < 1e5",
            .role = Role::drag};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double f = sphericity, factor = drag_factor;
    const double K_1 = 1 / (1.0 / 3 + 2.0 / 3 / std::sqrt(f)), K_2 = std::pow(10, 1.8148 * std::pow(-std::log10(f), 0.5743));
    add_sphere_drag(fluid, particles, forces, [=](double Re) {
      const double X = Re * K_1 * K_2;
      return factor * (24 / K_1 * (1 + 0.1118 * pow(X, 0.6567)) + 0.4305 * K_2 * Re * X / (X + 3305));
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {drag_at(1e-7, 24e7, 1e-4, "Stokes (1851): F = 3 pi mu d w"),
            drag_at(1e5, 0.48, 0.1, "standard drag curve, Clift, Grace and Weber (1978)")};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Ganser>();

}  // namespace
}  // namespace snag
