#include "dem/hold_motion.hpp"

#include <algorithm>
#include <numbers>

namespace snag {

namespace {
constexpr double two_pi = 2 * std::numbers::pi;
}

bool HoldMotion::moves() const {
  return rotation_speed != 0 || norm_squared(velocity) > 0 || (norm_squared(amplitude) > 0 && frequency != 0);
}

double HoldMotion::run(double t) const { return t < ramp ? 0.5 * t * t / ramp : t - 0.5 * ramp; }
double HoldMotion::rate(double t) const { return t < ramp ? t / ramp : 1; }

Vec3 HoldMotion::shift(double t) const {
  return run(t) * velocity + (std::sin(two_pi * frequency * t + phase) - std::sin(phase)) * amplitude;
}

Vec3 HoldMotion::turned(const Vec3& v, double t, double t2) const {
  return rotation_speed == 0 ? v : rotation(unit(axis), rotation_speed * (run(t2) - run(t))) * v;
}

Vec3 HoldMotion::moved(const Vec3& x, double t, double t2) const {
  if (!moves()) return x;
  const Vec3 from = origin + shift(t), to = origin + shift(t2);
  return rotation_speed == 0 ? x + (to - from) : to + turned(x - from, t, t2);
}

Vec3 HoldMotion::spin(double t) const { return rotation_speed * rate(t) * unit(axis); }

Vec3 HoldMotion::mean_spin(double t, double t2) const {
  return t2 > t ? rotation_speed * (run(t2) - run(t)) / (t2 - t) * unit(axis) : spin(t);
}

Vec3 HoldMotion::velocity_at(const Vec3& x, double t) const {
  return rate(t) * velocity + two_pi * frequency * std::cos(two_pi * frequency * t + phase) * amplitude +
         cross(spin(t), x - origin - shift(t));
}

double HoldMotion::largest_speed(double distance) const {
  return norm(velocity) + two_pi * std::abs(frequency) * norm(amplitude) + std::abs(rotation_speed) * distance;
}

}  // namespace snag
