#pragma once
// Monitors of the rags, a row a step and rag: rags.csv (the piece as a whole), passage.csv (where in the pump it is, with [rag_passage]),
// rag_forces.csv (forces over its particles), and contacts.csv, a row a step. A rag that is not in the run yet has no row.
#include <filesystem>
#include <vector>

#include "base/monitor.hpp"
#include "dem/rag_system.hpp"
#include "simulation/output/rag_forces.hpp"
#include "simulation/setup/passage.hpp"

namespace snag {

/// Of one rag at the end of a step.
struct RagRecord {
  double time = 0;  // s
  std::size_t rag = 0;
  RagState state;
  std::int64_t n_broken = 0, n_out = 0;  // bonds; particles beyond an outlet of the mesh
  double strain_p99 = 0;
  RagForceSpread forces;
  RagSnapshot seen;
  double angle = 0;  // of the centroid, unwrapped, rad
};

/// Of all contacts in a step.
struct ContactRecord {
  double time = 0;  // s
  std::int64_t n = 0, n_of_walls = 0, n_beyond_walls = 0, n_sub_steps = 0;
  double max_overlap_over_radius = 0;
};

class RagMonitors {
 public:
  /// A resumed run keeps rows up to from_time. Rank 0 writes; collective; throws Error(io).
  RagMonitors(const std::filesystem::path& folder, const RagSystem& rags, bool with_passage, bool resume, double from_time);
  /// The step just done; starts the measures of the contacts anew. Collective; throws Error(io).
  void after_step(RagSystem& rags, const Passage& passage, const RagForces& forces, double time);

  // over the whole run, kept by checkpoints
  double max_overlap() const { return max_overlap_; }
  double max_wall_overlap(std::size_t rag) const { return max_wall_overlap_[rag]; }
  double max_bond_strain_p99(std::size_t rag) const { return max_bond_strain_p99_[rag]; }
  std::int64_t most_beyond_walls() const { return static_cast<std::int64_t>(most_beyond_walls_); }
  std::vector<double> state() const;
  void restore(const std::vector<double>& state);
  /// The files; open on rank 0.
  std::vector<const Series*> series() const { return {&rags_.series(), &contacts_.series(), &passage_.series(), &forces_.series()}; }

 private:
  void measure_contacts(RagSystem& rags, double time);

  Monitor<RagRecord> rags_, passage_, forces_;  // open on rank 0
  Monitor<ContactRecord> contacts_;
  bool with_passage_;
  double max_overlap_ = 0, most_beyond_walls_ = 0;
  std::vector<double> max_wall_overlap_, max_bond_strain_p99_;  // [n_rags]
};

}  // namespace snag
