#pragma once
// Hertz-Mindlin contact of two elastic spheres, damped, with the history of slip:
//
//   F_n = 4/3 E* sqrt(R*) d^(3/2) + 2 sqrt(5/6) |B| sqrt(S_n m*) u_n       S_n = 2 E* sqrt(R* d)
//   F_t = -S_t xi - 2 sqrt(5/6) |B| sqrt(S_t m*) u_t                       S_t = 8 G* sqrt(R* d)
//   |S_t xi| <= mu max(F_n, 0),  |F_t| <= mu max(F_n, 0)                   B = ln e / sqrt(ln^2 e + pi^2)
//
//   F_n > 0 pushes apart; it also pulls at the end of a damped impact, as published: only so is the restitution e.
//   d    overlap, m
//   n    unit normal from body 1 to body 2
//   u    velocity of body 1 relative to body 2 at the contact, u_n = u.n (rate of d), u_t = u - u_n n
//   xi   slip (elastic tangential displacement), m: turned with the normal, grows by u_t dt, cut back where the spring alone would exceed
//        the Coulomb limit
//   1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2,  1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2,  E = 2 G (1 + nu)
//   1/R* = 1/R_1 + 1/R_2,  1/m* = 1/m_1 + 1/m_2
//
// Source: Jensen (2018) Eqs. 3.3-3.9 and 3.23, after Tsuji et al. (1992). The damping makes d^(5/4) a damped oscillator, so that e is exact
// for every speed (Antypov and Elliott 2011). An elastic impact at speed u lasts 2.9432 (m*^2/(k^2 u))^(1/5), k = 16/15 E* sqrt(R*).
// Branch-free, so that a loop over contacts vectorises.
#include <algorithm>
#include <cmath>

#include "base/vec3.hpp"

namespace snag {

/// Coefficients of the law for one pair of bodies.
struct HertzMindlin {
  double normal = 0;              // 4/3 E* sqrt(R*), N/m^1.5
  double tangential = 0;          // 8 G* sqrt(R*), N/m^1.5
  double normal_damping = 0;      // N s/m^1.25
  double tangential_damping = 0;  // N s/m^1.25
  double friction = 0;            // mu
};

/// State of one contact.
struct ContactMotion {
  double overlap = 0;  // d >= 0, m
  Vec3 normal;         // n
  Vec3 velocity;       // u, m/s
  Vec3 slip;           // xi before, m
};

struct ContactForce {
  Vec3 force;         // on body 1, N
  double normal = 0;  // F_n, N
  Vec3 slip;          // xi after, m
};

inline constexpr double smallest_square =
    1e-300;  // keeps 0/0 from being formed; far below the square of any length, speed or force that matters

/// Force on body 1 and the slip after `step` seconds.
[[gnu::always_inline]] inline ContactForce hertz_mindlin(const HertzMindlin& law, const ContactMotion& contact, double step) {
  const Vec3& n = contact.normal;
  const double root = std::sqrt(contact.overlap), quarter = std::sqrt(root);
  const double u_n = dot(contact.velocity, n);
  const Vec3 u_t = contact.velocity - u_n * n;
  const double F_n = law.normal * root * contact.overlap + law.normal_damping * quarter * u_n;
  const double limit = law.friction * std::max(F_n, 0.0);

  // Slip is turned into the present tangent plane without change of length.
  const Vec3 tangent = contact.slip - dot(contact.slip, n) * n;
  const Vec3 turned = std::sqrt(norm_squared(contact.slip) / (norm_squared(tangent) + smallest_square)) * tangent;
  Vec3 slip = turned + step * u_t;
  const double S_t = law.tangential * root;
  slip *= std::min(1.0, limit / (S_t * std::sqrt(norm_squared(slip)) + smallest_square));

  Vec3 F_t = -S_t * slip - law.tangential_damping * quarter * u_t;
  F_t *= std::min(1.0, limit / std::sqrt(norm_squared(F_t) + smallest_square));
  return {F_t - F_n * n, F_n, slip};
}

}  // namespace snag
