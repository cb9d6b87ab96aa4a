#pragma once
// How a rag passes through the domain: which part of it has gone out through an opening, and what happened when.
//
// An opening is a patch on which pressure is given, seen as a disc: its mean plane and the radius that holds it. A particle is out when it
// is beyond the plane and within 1.5 radii of the axis.
#include <string>
#include <vector>

#include "app/summary.hpp"
#include "dem/rag_system.hpp"
#include "mesh/mesh.hpp"
#include "solver/boundary.hpp"

namespace snag {

struct Opening {
  std::string name;
  Vec3 centre, normal;  // m; unit, out of the domain
  double radius = 0;    // m
};

/// Patches of the mesh on which pressure is given. Collective.
std::vector<Opening> openings(const Mesh& mesh, const BoundarySet& boundary);

class Passage {
 public:
  Passage(MPI_Comm comm, std::vector<Opening> openings, std::size_t n_rags);
  /// Look where the particles are now; new events get this time. Collective.
  void observe(const RagSystem& rags, double time);
  /// True once every rag is wholly out (false without rags).
  bool all_exited() const;
  /// exited, or upstream for one that has not left.
  std::string outcome(std::size_t rag) const;
  const std::vector<RagSummary::Event>& events(std::size_t rag) const { return events_[rag]; }
  /// Particles of each rag that are out.
  const std::vector<std::int64_t>& n_out() const { return n_out_; }

  /// The same after a resume: the times at which events happened, [n_rags][2], -1 where one did not.
  std::vector<double> state() const;
  void restore(const std::vector<double>& state);

 private:
  void set_event(std::size_t rag, int which, double time);
  MPI_Comm comm_;
  std::vector<Opening> openings_;
  std::vector<std::vector<RagSummary::Event>> events_;
  std::vector<double> event_times_;  // [n_rags][2]: first particle out, whole rag out; s, -1: not yet
  std::vector<std::int64_t> n_out_;
};

}  // namespace snag
