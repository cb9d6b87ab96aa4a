#pragma once
// Position and contacts of the rags in each step, which the passage tracker of each rag reads (observe/passage/passage_tracker.hpp), and
// the particles that have left the mesh.
//
// With [rag_passage] the flanges and the tongue of the pump define the passage (observe/passage/passage_geometry.hpp); without it a
// particle is out beyond a pressure outlet, and upstream beyond a pressure inlet.
#include <optional>
#include <vector>

#include "dem/rag_measures.hpp"
#include "dem/rag_system.hpp"
#include "observe/passage/opening.hpp"
#include "observe/passage/passage_geometry.hpp"
#include "observe/passage/passage_tracker.hpp"

namespace snag {

class Passage {
 public:
  Passage(MPI_Comm comm, std::vector<Opening> openings, std::optional<PassageGeometry> geometry, std::size_t n_rags);
  /// Looks where the particles are at the end of a step of length `step` that led to `time`, s; contacts are those since their measures
  /// were last reset. Collective.
  void observe(RagSystem& rags, double time, double step);

  /// When the last rag was wholly out, s; absent before that, and without rags.
  std::optional<double> all_exited_at() const;
  PassageResult verdict(std::size_t rag) const { return trackers_[rag].verdict(); }
  const std::optional<PassageGeometry>& geometry() const { return geometry_; }

  // Of the last look; the same on every rank.
  const PassageTracker& tracker(std::size_t rag) const { return trackers_[rag]; }
  const std::vector<RagSnapshot>& sightings() const { return sightings_; }
  const std::vector<RagState>& states() const { return states_; }
  /// Particles of each rag that are beyond a pressure outlet of the mesh.
  const std::vector<std::int64_t>& n_out() const { return n_out_; }
  /// Ratio of the axes of each rag when it was last there.
  double last_elongation(std::size_t rag) const { return last_elongation_[rag]; }

  /// What the next look needs of the past: numbers, for one resume.
  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  void look_at(const Vec3& x, std::int64_t* counts) const;

  MPI_Comm comm_;
  std::vector<Opening> openings_;
  std::optional<PassageGeometry> geometry_;
  std::vector<PassageTracker> trackers_;
  std::vector<RagSnapshot> sightings_;
  std::vector<RagState> states_;
  std::vector<std::int64_t> n_out_;
  std::vector<double> last_elongation_;
};

}  // namespace snag
