// A contact of particles 1 (lower id) and 2 with the normal n from 1 to 2, the arms a_1, a_2 from the centres to the contact point and a
// weight (dem/contacts/surface_contact.hpp):
//
//   u = v_1 + w_1 x a_1 - v_2 - w_2 x a_2                               relative velocity at the contact point
//   force  F on 1, -F on 2;   torque  a_1 x F + M on 1,  -a_2 x F - M on 2    (M: rolling friction; F, M: of the law, times the weight)
//
// The torques about any point sum to (x_1 + a_1 - x_2 - a_2) x F = 0: linear and angular momentum are kept to round-off.
#include "dem/contacts/pair_forces.hpp"

#include <cmath>

namespace snag {

namespace {
// Where a layer lies on another, the nearest of its particles has a share of at least 1/4 in each contact, at the middle of four. Less is
// that of particles farther off, whose plane may pass through what is near them where the cloth is bent.
constexpr double least_of_nearest = 0.25;
}  // namespace

struct PairForces::Block : ContactBlock {
  const ContactPair* pair = nullptr;  // all contacts of a block are of one kind
  int index[contact_block_size];      // into the list
  Vec3 arm_1[contact_block_size], arm_2[contact_block_size];
};

PairForces::PairForces(const std::vector<Rag>& rags, const ContactSettings& settings) : block_(std::make_unique<Block>()) {
  std::vector<const Rag*> kinds;
  const auto alike = [](const Rag& a, const Rag& b) {
    return a.radius == b.radius && a.layer_reach() == b.layer_reach() && a.surface_reach() == b.surface_reach() &&
           a.cloth_friction == b.cloth_friction && a.mass == b.mass && a.inertia == b.inertia && a.shear_modulus == b.shear_modulus &&
           a.poisson_ratio == b.poisson_ratio;
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
    const auto [p, q, as_points] = list.pairs[i];
    const ParticlePosition &x = particles.position[p], &y = particles.position[q];
    const ContactPair& kind = n_materials_ == 1 ? pairs_[0] : pair(particles.rag_of(p), particles.rag_of(q));
    PairSlip& slip = list.slip[i];
    const Vec3 d{y.x - x.x, y.y - x.y, y.z - x.z};
    SurfaceContact contact;
    if (as_points)
      contact = surface_contact::between_points(d, kind);
    else if (norm_squared(d) < kind.cutoff * kind.cutoff)
      contact = surface_contact::between(particles.surface[p], particles.surface[q], d, kind);
    if (!(contact.weight > 0)) {
      if (slip.touching > 0) slip = {};
      continue;
    }
    if (block_->n == contact_block_size || block_->pair != &kind) {
      evaluate(particles, list);
      block_->pair = &kind;
    }
    const ParticleMotion &u = particles.motion[p], &v = particles.motion[q];
    const Vec3 w_1{u.wx, u.wy, u.wz}, w_2{v.wx, v.wy, v.wz};
    const int c = block_->n++;
    block_->index[c] = i, block_->arm_1[c] = contact.arm_1, block_->arm_2[c] = contact.arm_2;
    block_->overlap[c] = contact.overlap, block_->weight[c] = contact.weight;
    put(block_->normal, c, contact.normal);
    put(block_->velocity, c, Vec3{u.vx - v.vx, u.vy - v.vy, u.vz - v.vz} + cross(w_1, contact.arm_1) - cross(w_2, contact.arm_2));
    put(block_->spin, c, w_1 - w_2);
    put(block_->slip, c, {slip.x, slip.y, slip.z});
  }
  evaluate(particles, list);
  return measures_;
}

void PairForces::evaluate(ContactParticles& particles, ContactList& list) {
  Block& b = *block_;
  if (b.n == 0) return;
  b.pair->law->evaluate(b, b.pair->rolling, step_);
  if (held_) add_to_held(list);
  double deepest = 0;
  int first = list.pairs[b.index[0]].p;  // pairs of one particle follow each other: its load is kept at hand
  ParticleLoad on_1 = particles.load[first];
  for (int c = 0; c < b.n; ++c) {
    const NearPair& pair = list.pairs[b.index[c]];
    if (pair.p != first) {
      particles.load[first] = on_1;
      first = pair.p, on_1 = particles.load[first];
    }
    const Vec3 force = get(b.force, c), rolling = get(b.rolling, c);
    on_1.add(force, cross(b.arm_1[c], force) + rolling);
    particles.load[pair.q].add(-force, -cross(b.arm_2[c], force) - rolling);
    list.slip[b.index[c]] = {b.slip[0][c], b.slip[1][c], b.slip[2][c], 1};
    deepest = std::max(deepest, std::min(b.weight[c] / least_of_nearest, 1.0) * b.overlap[c]);
    measures_.n_contacts += particles.owned(pair.p);
  }
  particles.load[first] = on_1;
  measures_.max_overlap_over_radius = std::max(measures_.max_overlap_over_radius, deepest / b.pair->smaller_reach);
  b.n = 0;
}

void PairForces::add_to_held(const ContactList& list) const {
  const Block& b = *block_;
  for (int c = 0; c < b.n; ++c) {
    ContactRates rates = b.pair->law->rates(b.overlap[c], step_);
    rates = {b.weight[c] * rates.normal, b.weight[c] * rates.tangential};
    const Vec3 n = get(b.normal, c);
    const NearPair& pair = list.pairs[b.index[c]];
    (*held_)[pair.p].add(n, rates, (1 / b.pair->radius_1) * b.arm_1[c]);
    (*held_)[pair.q].add(-n, rates, (1 / b.pair->radius_2) * b.arm_2[c]);
  }
}

}  // namespace snag
