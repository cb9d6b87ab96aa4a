#pragma once
// Drag in a suspension and in a packed bed, with the solid fraction 1 - epsilon at the particle, Re = rho |w| d/mu, V = pi d^3/6; F = K w:
//
//   Wen and Yu:  K_w = 3/4 V (rho |w|/d) C_d(Re) epsilon^(-4.65),   C_d of Schiller and Naumann
//   Ergun:       K_e = V (150 (1 - epsilon) mu/d^2 + 1.75 rho |w|/d)/epsilon^3
//
// w = u - v with the velocity u of the mixture, which the continuity equation of the water gives (docs/theory.md, 4.3): the flow rate over
// the whole area, as in Ergun's equation. F is all that the water does beside rho V (Du/Dt - g): in a bed the whole pressure drop, in
// settling the weight less that of the water displaced. Programs whose u is the velocity in the gaps, w_g = w/epsilon, and whose particles
// also have the force - V grad p of the mixture, state the same laws as F_A:
//
//   - V grad p = rho V (Du/Dt - g) + (1 - epsilon) F    (momentum of the water)
//   F = F_A + (1 - epsilon) F,   so that   F = F_A(w/epsilon)/epsilon
//
// Source: Ergun (1952), Chem. Eng. Progr. 48, 89-94; Wen and Yu (1966), Chem. Eng. Progr. Symp. Ser. 62, 100-111.
#include <algorithm>

#include "coupling/sphere_drag.hpp"

namespace snag {

/// A drag law that needs the solid fraction of a computed flow.
struct SuspensionDrag : SphereDrag {
  ForceDescription card_of(const char* name, const char* equation, const char* source, const char* valid_for) const {
    return {.name = name,
            .equation = equation,
            .source = source,
            .valid_for = valid_for,
            .samples = {.solid_fraction = true},
            .role = Role::drag};
  }
  /// Pressure drop of a packed bed 150 mu w (1 - epsilon)^2/(epsilon^3 d^2), of it V/(1 - epsilon) on a particle.
  static ReferenceCase packed_bed(double tolerance) {
    SphereState packed = stokes_limit().state;
    packed.solid_fraction = 0.6;
    const double over_stokes = 150.0 / 18 * 0.6 / std::pow(0.4, 3);
    return {.what = "packed bed in creeping flow",
            .source = "Ergun (1952)",
            .state = packed,
            .force = over_stokes * stokes_limit().force,
            .tolerance = tolerance};
  }
};

/// epsilon = 1 - solid fraction, at least 0.1: folds closer than the kernel resolves, whose solid fraction may pass 1, count as 0.9.
inline double void_fraction(double solid_fraction) { return std::max(1 - solid_fraction, 0.1); }

/// C_d Re that stands for K_w.
inline double wen_yu(double epsilon, double Re) {
  const double in_newton = Re >= 1000 ? 1 : 0, viscous = 24 * (1 + 0.15 * pow(Re, 0.687));
  return (viscous + in_newton * (0.44 * Re - viscous)) * pow(epsilon, -4.65);
}

/// C_d Re that stands for K_e.
inline double ergun(double epsilon, double Re) { return 4.0 / 3 * (150 * (1 - epsilon) + 1.75 * Re) / (epsilon * epsilon * epsilon); }

}  // namespace snag
