// A contact of particles 1 (lower id) and 2, with centres x and distance d:
//
//   n = (x_2 - x_1)/d,  overlap = r_1 + r_2 - d,  contact point at x_1 + l_1 n = x_2 - l_2 n,  l_i = d r_i/(r_1 + r_2)
//   u = v_1 + w_1 x l_1 n - v_2 + w_2 x l_2 n                                   relative velocity at the contact point
//   force  F on 1, -F on 2;   torque  l_1 n x F + M on 1,  l_2 n x F - M on 2    (M: rolling friction)
//
// The torques about any point sum to (x_1 - x_2) x F + (l_1 + l_2) n x F = 0: linear and angular momentum are kept to round-off.
#include "dem/contacts/pair_forces.hpp"

#include <cmath>

namespace snag {

struct PairForces::Block : PairBlock {
  const ContactPair* pair = nullptr;  // all contacts of a block are of one kind
  int index[contact_block_size];      // into the list

  void put(ContactVectors& field, double a, double b, double c) { field[0][n] = a, field[1][n] = b, field[2][n] = c; }
};

PairForces::PairForces(const std::vector<Rag>& rags, const ContactSettings& settings) : block_(std::make_unique<Block>()) {
  std::vector<const Rag*> kinds;
  const auto alike = [](const Rag& a, const Rag& b) {
    return a.radius == b.radius && a.layer_reach() == b.layer_reach() && a.cloth_friction == b.cloth_friction && a.mass == b.mass &&
           a.inertia == b.inertia && a.shear_modulus == b.shear_modulus && a.poisson_ratio == b.poisson_ratio;
  };
  for (const Rag& rag : rags) {
    std::size_t m = 0;
    while (m < kinds.size() && !alike(*kinds[m], rag)) ++m;
    if (m == kinds.size()) kinds.push_back(&rag);
    material_.push_back(static_cast<int>(m));
  }
  n_materials_ = static_cast<int>(kinds.size());
  for (const Rag* a : kinds)
    for (const Rag* b : kinds) pairs_.push_back(particle_pair(*a, *b, settings));
}

PairForces::~PairForces() = default;

PairMeasures PairForces::add(ContactParticles& particles, ContactList& list, double step, std::vector<HeldParticle>* held) {
  measures_ = {}, step_ = step, held_ = held;
  block_->n = 0, block_->pair = nullptr;
  for (int i = 0; i < static_cast<int>(list.pairs.size()); ++i) {
    const auto [p, q] = list.pairs[i];
    const ParticlePosition &a = particles.position[p], &b = particles.position[q];
    const ContactPair& kind = n_materials_ == 1 ? pairs_[0] : pair(particles.rag_of(p), particles.rag_of(q));
    PairSlip& slip = list.slip[i];
    const double dx = b.x - a.x, dy = b.y - a.y, dz = b.z - a.z;
    if (!(dx * dx + dy * dy + dz * dz < kind.reach * kind.reach)) {
      if (slip.touching > 0) slip = {};
      continue;
    }
    if (block_->n == contact_block_size || block_->pair != &kind) {
      evaluate(particles, list);
      block_->pair = &kind;
    }
    const ParticleMotion &u = particles.motion[p], &v = particles.motion[q];
    const double f1 = kind.arm_1, f2 = kind.arm_2;
    block_->index[block_->n] = i;
    block_->put(block_->x, dx, dy, dz);
    block_->put(block_->v, u.vx - v.vx, u.vy - v.vy, u.vz - v.vz);
    block_->put(block_->w, f1 * u.wx + f2 * v.wx, f1 * u.wy + f2 * v.wy, f1 * u.wz + f2 * v.wz);
    block_->put(block_->spin, u.wx - v.wx, u.wy - v.wy, u.wz - v.wz);
    block_->put(block_->slip, slip.x, slip.y, slip.z);
    ++block_->n;
  }
  evaluate(particles, list);
  return measures_;
}

void PairForces::evaluate(ContactParticles& particles, ContactList& list) {
  Block& b = *block_;
  if (b.n == 0) return;
  b.pair->law->evaluate(b, *b.pair, step_);
  if (held_) add_to_held(list);
  double deepest = 0;
  const double f1 = b.pair->arm_1, f2 = b.pair->arm_2;
  int first = list.pairs[b.index[0]].p;  // pairs of one particle follow each other: its load is kept at hand
  ParticleLoad on_1 = particles.load[first];
  for (int c = 0; c < b.n; ++c) {
    const auto [p, q] = list.pairs[b.index[c]];
    if (p != first) {
      particles.load[first] = on_1;
      first = p, on_1 = particles.load[p];
    }
    ParticleLoad& on_2 = particles.load[q];
    on_1.fx += b.force[0][c], on_1.fy += b.force[1][c], on_1.fz += b.force[2][c];
    on_2.fx -= b.force[0][c], on_2.fy -= b.force[1][c], on_2.fz -= b.force[2][c];
    on_1.tx += f1 * b.arm_torque[0][c] + b.rolling[0][c];
    on_1.ty += f1 * b.arm_torque[1][c] + b.rolling[1][c];
    on_1.tz += f1 * b.arm_torque[2][c] + b.rolling[2][c];
    on_2.tx += f2 * b.arm_torque[0][c] - b.rolling[0][c];
    on_2.ty += f2 * b.arm_torque[1][c] - b.rolling[1][c];
    on_2.tz += f2 * b.arm_torque[2][c] - b.rolling[2][c];
    list.slip[b.index[c]] = {b.slip[0][c], b.slip[1][c], b.slip[2][c], 1};
    deepest = std::max(deepest, b.overlap[c]);
    measures_.n_contacts += particles.owned(p);
  }
  particles.load[first] = on_1;
  measures_.max_overlap_over_radius = std::max(measures_.max_overlap_over_radius, deepest / b.pair->smaller_radius);
  b.n = 0;
}

void PairForces::add_to_held(const ContactList& list) const {
  const Block& b = *block_;
  for (int c = 0; c < b.n; ++c) {
    const ContactRates rates = b.pair->law->rates(b.overlap[c], step_);
    const Vec3 r = get(b.x, c), n = 1 / std::sqrt(norm_squared(r) + smallest_square) * r;
    const auto [p, q] = list.pairs[b.index[c]];
    (*held_)[p].add(n, rates), (*held_)[q].add(-n, rates);
  }
}

}  // namespace snag
