#pragma once
// Drag in a suspension and in a packed bed, with the solid fraction 1 - epsilon at the particle, w the slip in the gaps, Re = rho |w| d/mu,
// V = pi d^3/6; F = K w:
//
//   Wen and Yu:  K_w = 3/4 V (rho |w|/d) C_d(Re_s) epsilon^(-1.65),   Re_s = epsilon Re,   C_d of Schiller and Naumann
//   Ergun:       K_e = V (150 (1 - epsilon) mu/(epsilon d^2) + 1.75 rho |w|/d)
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
  /// Pressure drop of a packed bed 150 mu U (1 - epsilon)^2/(epsilon^3 d^2), U = epsilon w; of it epsilon V/(1 - epsilon) on a particle.
  static ReferenceCase packed_bed(double tolerance) {
    SphereState packed = stokes_limit().state;
    packed.solid_fraction = 0.6;
    const double over_stokes = 150.0 / 18 * 0.6 / 0.4;
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
  const double Re_s = epsilon * Re, in_newton = Re_s >= 1000 ? 1 : 0, viscous = 24 * (1 + 0.15 * pow(Re_s, 0.687));
  return (viscous + in_newton * (0.44 * Re_s - viscous)) * pow(epsilon, -2.65);
}

/// C_d Re that stands for K_e.
inline double ergun(double epsilon, double Re) { return 4.0 / 3 * (150 * (1 - epsilon) / epsilon + 1.75 * Re); }

}  // namespace snag
