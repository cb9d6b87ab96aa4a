// Angle of a wall that turns: Omega t, with a ramp Omega t^2/(2 T) up to T and Omega (t - T/2) then.
#include "dem/walls/wall_motion.hpp"

namespace snag {

WallPose wall_pose(const WallMotion& motion, double time) {
  WallPose pose;
  const Vec3 n = unit(motion.axis);
  pose.centre = motion.origin;
  pose.origin = motion.origin + time * motion.velocity;
  pose.velocity = motion.velocity;
  pose.spin = (time < motion.ramp ? motion.speed * time / motion.ramp : motion.speed) * n;
  if (motion.speed == 0) return pose;
  const double turned = time < motion.ramp ? 0.5 * time * time / motion.ramp : time - 0.5 * motion.ramp;
  pose.rotation = rotation(n, motion.speed * turned);
  return pose;
}

}  // namespace snag
