#pragma once
// Blocks of contacts of one pair of bodies, over which a law is a loop that vectorises. A law is a function object
//   ContactForce operator()(const ContactMotion& contact, double step) const      (inlined, without branches)
// with its coefficients; BlockLaw makes a PairLaw of it.
//
// Normal, overlap, relative velocity and weight of a contact are given (dem/contacts/pair_forces.cpp, wall_contacts.cpp); force and rolling
// torque are those of the law times the weight.
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

/// Contacts of one pair of bodies. In: normal, relative velocity at the contact, relative rotation, slip, overlap, weight; out: force and
/// rolling torque on body 1, slip.
struct ContactBlock {
  int n = 0;
  alignas(64) ContactVectors normal = {}, velocity = {}, spin = {}, slip = {};
  alignas(64) double overlap[contact_block_size] = {}, weight[contact_block_size] = {};
  alignas(64) ContactVectors force = {}, rolling = {};

  // One contact, apart from its loop: temporaries of a loop body marked simd would be kept in memory and stop the vectoriser.
  template <class Force>
  [[gnu::always_inline]] inline void evaluate_one(const Force& law, const RollingFriction& rolls, int c, double step) {
    const Vec3 e{normal[0][c], normal[1][c], normal[2][c]};
    const ContactMotion contact{overlap[c], e, {velocity[0][c], velocity[1][c], velocity[2][c]}, {slip[0][c], slip[1][c], slip[2][c]}};
    const ContactForce result = law(contact, step);
    const Vec3 relative{spin[0][c], spin[1][c], spin[2][c]};
    const Vec3 M = rolling_friction(rolls, weight[c] * result.normal, relative - dot(relative, e) * e, step);
    force[0][c] = weight[c] * result.force.x, force[1][c] = weight[c] * result.force.y, force[2][c] = weight[c] * result.force.z;
    rolling[0][c] = M.x, rolling[1][c] = M.y, rolling[2][c] = M.z;
    slip[0][c] = result.slip.x, slip[1][c] = result.slip.y, slip[2][c] = result.slip.z;
  }
};

/// Evaluates blocks with the law `Force`.
template <class Force>
class BlockLaw : public PairLaw {
 public:
  explicit BlockLaw(const Force& force) : force_(force) {}
  void evaluate(ContactBlock& block, const RollingFriction& rolling, double step) const final {
    const Force law = force_;
    const RollingFriction rolls = rolling;
    const int n = padded(block.n);
#pragma omp simd
    for (int c = 0; c < n; ++c) block.evaluate_one(law, rolls, c, step);
  }

 protected:
  Force force_;
};

}  // namespace snag
