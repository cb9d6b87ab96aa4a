#pragma once
// Prescribed rigid motion of held particles. A point X of the hold at time 0 is at time t at
//
//   x(t) = o + s(t) + R(n, theta(t)) (X - o),   s = V tau + A (sin(2 pi f t + phi) - sin(phi)),   theta = Omega tau
//   tau = t, with a ramp T: t^2/(2 T) up to T, t - T/2 then
//
//   o, n    a point of the axis at time 0, m, and the axis, unit;  Omega: speed of rotation, rad/s
//   V, A    velocity of translation, m/s; amplitude of an oscillation of frequency f, Hz, and phase phi, rad
#include "base/vec3.hpp"

namespace snag {

struct HoldMotion {
  Vec3 velocity, amplitude;             // V, m/s; A, m
  double frequency = 0, phase = 0;      // f, Hz; phi, rad
  Vec3 axis{0, 0, 1}, origin;           // n, of any length but zero; o, m
  double rotation_speed = 0, ramp = 0;  // Omega, rad/s; T, s

  bool moves() const;
  /// Where a point that is at x at the time t is at the time t2.
  Vec3 moved(const Vec3& x, double t, double t2) const;
  /// A vector that turns with the hold.
  Vec3 turned(const Vec3& v, double t, double t2) const;
  /// Velocity of the point at x at the time t, m/s.
  Vec3 velocity_at(const Vec3& x, double t) const;
  /// Mean rotation between two times, rad/s.
  Vec3 mean_spin(double t, double t2) const;
  Vec3 spin(double t) const;
  /// Bound of the speed of a point whose distance from o was `distance` (m) at time 0, m/s.
  double largest_speed(double distance) const;

 private:
  double run(double t) const;   // tau
  double rate(double t) const;  // d tau/dt
  Vec3 shift(double t) const;   // s
};

}  // namespace snag
