#pragma once
// Rolling friction: a torque of fixed size against the relative rolling of two bodies in contact,
//
//   M = -mu_r R* max(F_n, 0) w_r / |w_r|,    w_r = (w_1 - w_2) - ((w_1 - w_2).n) n
//
// on body 1, the opposite on body 2, so that angular momentum is kept. Near rest the sign would chatter: M is at most what would stop the
// relative rolling in `stopping_steps` sub-steps, M <= I* |w_r| / (stopping_steps dt), 1/I* = 1/I_1 + 1/I_2. Source: directional constant
// torque, Zhou et al. (1999); coefficient Jensen (2018) Table 3.2.
#include <algorithm>
#include <cmath>

#include "base/vec3.hpp"

namespace snag {

inline constexpr double stopping_steps =
    8;  // a particle of a crumpled sheet has some six contacts: together they must not reverse its rotation

struct RollingFriction {
  double arm = 0;      // mu_r R*, m
  double inertia = 1;  // I*, kg m2
};

/// Torque on body 1, N m. `spin`: w_r, rad/s; `normal_force`: F_n, N.
[[gnu::always_inline]] inline Vec3 rolling_friction(const RollingFriction& law, double normal_force, const Vec3& spin, double step) {
  const double torque = law.arm * std::max(normal_force, 0.0);
  const double rate = std::max(std::sqrt(norm_squared(spin) + 1e-200), stopping_steps * step * torque / law.inertia);
  return -torque / rate * spin;
}

}  // namespace snag
