#pragma once
// Forces between the particles of a list: the laws in blocks of contacts, so that they vectorise; loads added in the order of the list.
#include <cstdint>
#include <memory>
#include <vector>

#include "dem/contacts/contact_list.hpp"
#include "dem/contacts/contact_pair.hpp"
#include "dem/contacts/contact_particles.hpp"
#include "dem/contacts/held_particle.hpp"

namespace snag {

struct PairMeasures {
  std::int64_t n_contacts = 0;         // of this evaluation, counted where the lower particle is owned
  double max_overlap_over_radius = 0;  // of this evaluation
};

class PairForces {
 public:
  PairForces(const std::vector<Rag>& rags, const ContactSettings& settings);
  ~PairForces();

  /// Adds to particles.load, moves the slip of touching pairs on by `step` (s) and clears that of pairs that part. `held`: [particles], if
  /// the contacts are to be added to it, or null.
  PairMeasures add(ContactParticles& particles, ContactList& list, double step, std::vector<HeldParticle>* held);

  /// Coefficients of a contact of two rags, lower particle id first.
  const ContactPair& pair(int rag_1, int rag_2) const { return pairs_[material_[rag_1] * n_materials_ + material_[rag_2]]; }
  const std::vector<ContactPair>& pairs() const { return pairs_; }

 private:
  struct Block;
  void evaluate(ContactParticles& particles, ContactList& list);
  void add_to_held(const ContactList& list) const;

  int n_materials_ = 0;
  std::vector<int> material_;       // [n_rags]: rags that are alike to contacts share one
  std::vector<ContactPair> pairs_;  // [n_materials][n_materials]
  std::unique_ptr<Block> block_;
  PairMeasures measures_;
  double step_ = 0;
  std::vector<HeldParticle>* held_ = nullptr;
};

}  // namespace snag
