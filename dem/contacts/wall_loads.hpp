#pragma once
// What rags exert on walls through their contacts, averaged over the sub-steps of a step from their impulses.
//
//   F = -sum f dt / T,   M = a . sum ((c - o) x (-f) - m) dt / T,   P = sum (f . u(c) + m . w) dt / T
//
//   f, m   force (normal and friction apart) and rolling torque of a contact on its particle, N, N m;  c: the contact point, m
//   o, a   a point of the wall's axis now, and the axis;  u, w: velocity of the wall at c, m/s, and its rotation, rad/s
//   T      duration of the step, s
//
// F and M act on the wall, P is the power that the wall gives to the rags: -M Omega where it turns about its axis alone. Sums are
// double-double (parallel/sum.hpp), so that they do not depend on the number of ranks.
#include <array>

#include "dem/walls/wall_motion.hpp"
#include "parallel/running_sum.hpp"

namespace snag {

/// Mean over a step, of all ranks.
struct WallLoad {
  Vec3 normal_force, friction_force;              // on the wall, N
  double normal_torque = 0, friction_torque = 0;  // on the wall about its axis, rolling friction in the second, N m
  double power = 0;                               // given to the rags, W
  Vec3 force() const { return normal_force + friction_force; }
  double torque() const { return normal_torque + friction_torque; }
};

/// Of one contact in one sub-step.
struct WallContactForce {
  Vec3 point, normal;          // contact point, m; unit, from the particle to the wall
  Vec3 force, rolling_torque;  // on the particle, N, N m
};

/// Impulses on one part of the walls, on this rank.
class WallImpulse {
 public:
  void add(const WallContactForce& contact, const WallPose& pose, const Vec3& axis, double step);
  static constexpr int n_sums = 9;
  const std::array<RunningSum, n_sums>& terms() const { return terms_; }

 private:
  std::array<RunningSum, n_sums> terms_;  // N s, N m s, J
};

/// [parts] means over `duration`, s; zeros where that is zero. Collective.
std::vector<WallLoad> mean_loads(MPI_Comm comm, std::span<const WallImpulse> parts, double duration);

}  // namespace snag
