#pragma once
// What a pair of bodies in contact has in common: coefficients of the laws, geometry, and the steps that resolve it.
//
//   Rayleigh time (of a surface wave along a particle)   T_R = pi r sqrt(rho/G) / (0.1631 nu + 0.8766)
//   Hertz time (of an elastic impact at speed u)         T_H = 2.9432 (m*^2 / (k^2 u))^(1/5),  k = 16/15 E* sqrt(R*)
//   deepest overlap of that impact                       d = (m* u^2 / k)^(2/5)
//   stability of the damped contact spring at d          dt < 2/omega (sqrt(1 + zeta^2) - zeta)
//                                                        omega^2 = S q/m*,  zeta = sqrt(5/6) |B| sqrt(q)
//     q = 1 for the normal spring, 7/2 for the tangential one (the sphere also turns); velocities lag half a step
// Sources: Rayleigh time, Thornton (2015); impact, Johnson (1985) section 11.4.
#include <string>

#include "dem/contacts/contact_settings.hpp"
#include "dem/contacts/hertz_mindlin.hpp"
#include "dem/contacts/rolling_friction.hpp"
#include "dem/particles/rag.hpp"

namespace snag {

/// Coefficient of Eq. 3.5 for the restitution e, |ln e| / sqrt(ln^2 e + pi^2).
double damping_of_restitution(double restitution);

/// A pair of particles, or a particle and a wall.
struct ContactPair {
  HertzMindlin law;
  RollingFriction rolling;
  double reach = 0;             // distance of the centres below which they touch: r_1 + r_2, or r_1 of a wall, m
  double arm_1 = 0, arm_2 = 0;  // of the distance of the centres, where the contact point lies: r_1/(r_1 + r_2), r_2/(r_1 + r_2)
  double smaller_radius = 0;    // m
  double equivalent_mass = 0;   // m*, kg
  double damping = 0;           // |B|
};

/// Contact of a particle of rag `a` (1) with one of rag `b` (2).
ContactPair particle_pair(const Rag& a, const Rag& b, const ContactSettings& settings);
/// Contact of a particle (1) with a wall (2): a body of the particle's material, flat and at rest, E* and G* multiplied by
/// wall_stiffness_factor.
ContactPair wall_pair(const Rag& rag, const ContactSettings& settings);

double rayleigh_time(const Rag& rag);                         // s
double hertz_time(const ContactPair& pair, double speed);     // s
double hertz_overlap(const ContactPair& pair, double speed);  // deepest of an elastic impact, m
/// Largest step of the pair, s: T_H/8 at this speed, or where the damped springs at the deepest overlap become unstable.
double stable_contact_step(const ContactPair& pair, double speed);

}  // namespace snag
