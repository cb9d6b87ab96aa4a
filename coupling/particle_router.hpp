#pragma once
// Messages between the rank that moves a particle and the ranks whose cells lie around it: sparse, planned once a step, used many times.
//
// An entry is a pair (particle of this rank, rank that it is sent to). Entries are sorted by rank, so that sums over the answers to one
// particle run over the ranks in ascending order.
#include <mpi.h>

#include <span>
#include <vector>

namespace snag {

class ParticleRouter {
 public:
  explicit ParticleRouter(MPI_Comm comm) : comm_(comm) {}

  /// `particles_for[rank]`: particles of this rank that `rank` has to hear of. Collective.
  void plan(const std::vector<std::vector<int>>& particles_for);
  /// Drops entries, and what was received, where `keeps_entry` [n_entries] and `keeps_received` [n_received] are 0. Both sides must agree
  /// on each; no message is sent.
  void keep(std::span<const char> keeps_entry, std::span<const char> keeps_received);
  int n_entries() const { return static_cast<int>(particle_.size()); }
  int n_received() const { return receive_start_.empty() ? 0 : receive_start_.back(); }
  /// Particle and rank of an entry.
  int particle(int entry) const { return particle_[entry]; }
  int rank(int entry) const { return rank_[entry]; }

  /// Particles -> ranks: [n_entries][components] -> [n_received][components], in the order of ranks and entries there. Collective.
  void forward(std::span<const double> entries, int components, std::vector<double>& received) const;
  /// Values of particles [n][components], repeated for each entry, then forward. Collective.
  void forward_particles(std::span<const double> particles, int components, std::vector<double>& received) const;
  /// Ranks -> particles, the way back: [n_received][components] -> [n_entries][components]. Collective.
  void back(std::span<const double> received, int components, std::vector<double>& entries) const;

 private:
  /// Send the pieces of `from` to the ranks and receive the pieces of `to`; pieces are bounded by the starts, in items.
  void exchange(const double* from, const std::vector<int>& from_start, double* to, const std::vector<int>& to_start, int components) const;

  MPI_Comm comm_;
  std::vector<int> particle_, rank_;             // of the entries
  std::vector<int> send_start_, receive_start_;  // [ranks + 1]
};

}  // namespace snag
