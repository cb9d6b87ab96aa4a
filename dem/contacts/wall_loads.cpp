#include "dem/contacts/wall_loads.hpp"

namespace snag {

void WallImpulse::add(const WallContactForce& contact, const WallPose& pose, const Vec3& axis, double step) {
  const Vec3 arm = contact.point - pose.origin, normal = dot(contact.force, contact.normal) * contact.normal,
             friction = contact.force - normal;
  const double power = dot(contact.force, pose.velocity_at(contact.point)) + dot(contact.rolling_torque, pose.spin);
  const double terms[n_sums] = {-normal.x,
                                -normal.y,
                                -normal.z,
                                -friction.x,
                                -friction.y,
                                -friction.z,
                                -dot(axis, cross(arm, normal)),
                                -dot(axis, cross(arm, friction) + contact.rolling_torque),
                                power};
  for (int i = 0; i < n_sums; ++i) terms_[static_cast<std::size_t>(i)].add(step * terms[i]);
}

std::vector<WallLoad> mean_loads(MPI_Comm comm, std::span<const WallImpulse> parts, double duration) {
  std::vector<WallLoad> loads(parts.size());
  if (!(duration > 0)) return loads;
  std::vector<RunningSum> terms;
  for (const WallImpulse& part : parts) terms.insert(terms.end(), part.terms().begin(), part.terms().end());
  std::vector<double> mean = sums(comm, terms);
  for (double& value : mean) value /= duration;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double* m = &mean[p * WallImpulse::n_sums];
    loads[p] = {.normal_force = {m[0], m[1], m[2]},
                .friction_force = {m[3], m[4], m[5]},
                .normal_torque = m[6],
                .friction_torque = m[7],
                .power = m[8]};
  }
  return loads;
}

}  // namespace snag
