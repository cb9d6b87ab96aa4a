#pragma once
// Rigid motion of a wall, evaluated from the time: turning about an axis that may itself translate.
#include "base/vec3.hpp"

namespace snag {

struct WallMotion {
  Vec3 axis{0, 0, 1};  // of any length but zero
  Vec3 origin;         // a point of the axis at time 0, m
  double speed = 0;    // Omega, rad/s, right-handed about axis
  Vec3 velocity;       // V, m/s
  double ramp = 0;     // T, s: the angular speed grows from zero, Omega min(t/T, 1)

  bool moves() const { return speed != 0 || norm_squared(velocity) > 0; }
};

/// Where a wall's frame is at one time: x = origin + R (X - centre), R orthonormal; velocity of a point u = velocity + spin x (x - origin).
struct WallPose {
  Mat3 rotation{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  // R: frame of the wall -> fixed frame
  Vec3 centre;                                                 // o, in the frame of the wall, m
  Vec3 origin;                                                 // o + V t, m
  Vec3 velocity;                                               // V, m/s
  Vec3 spin;                                                   // Omega n, rad/s

  Vec3 turned(const Vec3& v) const { return rotation * v; }
  Vec3 turned_back(const Vec3& v) const { return v.x * rotation[0] + v.y * rotation[1] + v.z * rotation[2]; }
  /// Point of the fixed frame in the frame of the wall.
  Vec3 in_wall(const Vec3& x) const { return centre + turned_back(x - origin); }
  Vec3 in_space(const Vec3& X) const { return origin + turned(X - centre); }
  /// Velocity of the wall's material at the point x of the fixed frame, m/s.
  Vec3 velocity_at(const Vec3& x) const { return velocity + cross(spin, x - origin); }
};

/// Pose at time t, s; exact, not integrated.
WallPose wall_pose(const WallMotion& motion, double time);

}  // namespace snag
