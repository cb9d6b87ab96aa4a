#pragma once
// List of pairs of particles that are or may soon be in contact, with the slip of those that are (a Verlet list from a cell grid).
//
// A pair is listed when its centres are nearer than contact_distance + skin and it is neither bonded nor of two ghosts. The list holds
// every pair that can touch until a particle has moved skin/2. Cost of a build: proportional to the number of particles.
#include <cstdint>
#include <span>
#include <vector>

#include "base/parameter.hpp"
#include "dem/contacts/contact_particles.hpp"

namespace snag {

/// Two particles by local number, p < q.
struct NearPair {
  int p = 0, q = 0;
  bool as_points = false;  // ContactParticles::near_on_lattice
};

/// Slip xi of a touching pair, m; zero and not touching otherwise.
struct alignas(32) PairSlip {
  double x = 0, y = 0, z = 0, touching = 0;
};

/// The same by ids: survives new lists, other ranks and restarts.
struct StoredSlip {
  std::int64_t low = 0, high = 0;
  Vec3 slip;
  bool operator<(const StoredSlip& b) const { return low != b.low ? low < b.low : high < b.high; }
};

/// Which pairs can touch: particles of one piece, particles of two.
struct ListedPairs {
  bool within_pieces = true, between_pieces = true;
};

class ContactList {
 public:
  ContactList(const std::vector<Rag>& rags, double skin);
  /// Distance of two centres beyond which no pair is listed, m.
  double cutoff() const { return furthest_ + skin_; }

  /// New list from the marked positions; pairs that are still near keep their slip, and pairs that were stored take theirs. Marks the rows
  /// that are near.
  void build(ContactParticles& particles, ListedPairs listed = {});
  /// All touching pairs, sorted; call before particles are assigned anew.
  std::vector<StoredSlip> touching(const ContactParticles& particles) const;
  /// Slip to be given to pairs at the next build. A pair may come twice, with the same slip.
  void store(const std::vector<StoredSlip>& slips);
  const std::vector<StoredSlip>& stored() const { return stored_; }

  std::vector<NearPair> pairs;  // sorted by p, then q
  std::vector<PairSlip> slip;   // [pairs]

 private:
  void sort_into_cells(const ContactParticles& particles);
  void find_partners(const ContactParticles& particles, int p, ListedPairs listed);

  const std::vector<Rag>* rags_;
  double skin_, furthest_ = 0;  // m; over all pairs of rags
  std::vector<StoredSlip> stored_;
  // cells: x fastest, one empty layer around, so that the neighbours of a cell in a row of cells are one range of `sorted_`
  Vec3 origin_;
  double cell_width_ = 0;
  int cells_[3] = {0, 0, 0};
  std::vector<int> cell_of_, cell_start_, sorted_;
  std::vector<int> partners_;
};

}  // namespace snag
