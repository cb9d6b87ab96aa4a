// Rodrigues' rotation: R = cos(theta) 1 + sin(theta) [n]x + (1 - cos(theta)) n n^T, theta = Omega t, with a ramp Omega t^2/(2 T) up to T
// and Omega (t - T/2) then.
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
  const double theta = motion.speed * turned, c = std::cos(theta), s = std::sin(theta);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) pose.rotation[i][j] = (1 - c) * n[i] * n[j] + (i == j ? c : 0.0);
  pose.rotation[0].y -= s * n.z, pose.rotation[1].x += s * n.z;
  pose.rotation[2].x -= s * n.y, pose.rotation[0].z += s * n.y;
  pose.rotation[1].z -= s * n.x, pose.rotation[2].y += s * n.x;
  return pose;
}

}  // namespace snag
