#pragma once
// Blocks of contacts of one pair of bodies, over which a law is a loop that vectorises. A law is a function object
//   ContactForce operator()(const ContactMotion& contact, double step) const      (inlined, without branches)
// with its coefficients; BlockLaw makes a PairLaw of it.
//
// Contact of two particles with centres x_1, x_2 at the distance d:  n = (x_2 - x_1)/d,  overlap = reach - d
// Contact of a particle at the signed distance s of a wall:  overlap = min(reach - s, 2 reach), n and relative velocity are given
#include "dem/contacts/contact_law.hpp"
#include "dem/contacts/rolling_friction.hpp"

namespace snag {

inline constexpr int contact_block_size = 64;  // contacts: the arrays of a block stay in the first-level cache
inline constexpr int contact_lanes = 8;        // doubles of the widest vector: blocks are padded to it, so that every contact goes through
                                               // the same instructions
using ContactVectors = double[3][contact_block_size];

inline void put(ContactVectors& field, int c, const Vec3& v) { field[0][c] = v.x, field[1][c] = v.y, field[2][c] = v.z; }
inline Vec3 get(const ContactVectors& field, int c) { return {field[0][c], field[1][c], field[2][c]}; }

/// Number of contacts of a block with what it is padded by.
inline int padded(int n) { return (n + contact_lanes - 1) / contact_lanes * contact_lanes; }

/// What two bodies have in common but the law.
struct ContactGeometry {
  RollingFriction rolling;
  double reach = 0;  // distance of the centres below which they touch: r_1 + r_2, or r_1 of a wall, m (r: Rag::layer_reach, wall_reach)
  double arm_1 = 0, arm_2 = 0;  // of the distance of the centres, where the contact point lies: r_1/(r_1 + r_2), r_2/(r_1 + r_2)
  double smaller_radius = 0;    // of these, m
};

/// Contacts of two particles. In: difference of positions, of velocities, rotation l_1 w_1 + l_2 w_2 (over d), relative rotation, slip;
/// out: force, torque n x F, rolling torque, slip, overlap.
struct PairBlock {
  int n = 0;
  alignas(64) ContactVectors x = {}, v = {}, w = {}, spin = {}, slip = {};
  alignas(64) ContactVectors force = {}, arm_torque = {}, rolling = {};
  alignas(64) double overlap[contact_block_size] = {};

  // One contact, apart from its loop: temporaries of a loop body marked simd would be kept in memory and stop the vectoriser.
  template <class Force>
  [[gnu::always_inline]] inline void evaluate_one(const Force& law, const ContactGeometry& bodies, int c, double step) {
    const Vec3 r{x[0][c], x[1][c], x[2][c]};
    const double distance = std::sqrt(norm_squared(r) + smallest_square);
    ContactMotion contact;
    contact.overlap = std::max(bodies.reach - distance, 0.0);
    contact.normal = (1 / distance) * r;
    contact.velocity = Vec3{v[0][c], v[1][c], v[2][c]} + cross(Vec3{w[0][c], w[1][c], w[2][c]}, r);
    contact.slip = {slip[0][c], slip[1][c], slip[2][c]};
    const ContactForce result = law(contact, step);
    const Vec3 relative{spin[0][c], spin[1][c], spin[2][c]};
    const Vec3 M = rolling_friction(bodies.rolling, result.normal, relative - dot(relative, contact.normal) * contact.normal, step);
    const Vec3 torque = cross(r, result.force);
    force[0][c] = result.force.x, force[1][c] = result.force.y, force[2][c] = result.force.z;
    arm_torque[0][c] = torque.x, arm_torque[1][c] = torque.y, arm_torque[2][c] = torque.z;
    rolling[0][c] = M.x, rolling[1][c] = M.y, rolling[2][c] = M.z;
    slip[0][c] = result.slip.x, slip[1][c] = result.slip.y, slip[2][c] = result.slip.z;
    overlap[c] = contact.overlap;
  }
};

/// Contacts of a particle with walls. In: normal, relative velocity at the contact, relative rotation, slip, distance; out: force, torque,
/// slip.
struct WallBlock {
  int n = 0;
  alignas(64) ContactVectors normal = {}, velocity = {}, spin = {}, slip = {};
  alignas(64) double distance[contact_block_size] = {};
  alignas(64) ContactVectors force = {}, torque = {};

  template <class Force>
  [[gnu::always_inline]] inline void evaluate_one(const Force& law, const ContactGeometry& bodies, int c, double step) {
    const Vec3 e{normal[0][c], normal[1][c], normal[2][c]};
    const ContactMotion contact{std::min(bodies.reach - distance[c], 2 * bodies.reach),
                                e,
                                {velocity[0][c], velocity[1][c], velocity[2][c]},
                                {slip[0][c], slip[1][c], slip[2][c]}};
    const ContactForce result = law(contact, step);
    const Vec3 relative{spin[0][c], spin[1][c], spin[2][c]};
    const Vec3 M =
        cross(distance[c] * e, result.force) + rolling_friction(bodies.rolling, result.normal, relative - dot(relative, e) * e, step);
    force[0][c] = result.force.x, force[1][c] = result.force.y, force[2][c] = result.force.z;
    torque[0][c] = M.x, torque[1][c] = M.y, torque[2][c] = M.z;
    slip[0][c] = result.slip.x, slip[1][c] = result.slip.y, slip[2][c] = result.slip.z;
  }
};

/// Evaluates blocks with the law `Force`.
template <class Force>
class BlockLaw : public PairLaw {
 public:
  explicit BlockLaw(const Force& force) : force_(force) {}
  void evaluate(PairBlock& block, const ContactGeometry& bodies, double step) const final { loop(block, bodies, step); }
  void evaluate(WallBlock& block, const ContactGeometry& bodies, double step) const final { loop(block, bodies, step); }

 protected:
  Force force_;

 private:
  template <class Block>
  void loop(Block& block, const ContactGeometry& given_bodies, double step) const {
    const Force law = force_;
    const ContactGeometry bodies = given_bodies;
    const int n = padded(block.n);
#pragma omp simd
    for (int c = 0; c < n; ++c) block.evaluate_one(law, bodies, c, step);
  }
};

}  // namespace snag
