#pragma once
// How fast the rags of a case can be: from the water, the walls, their start and their fall. A particle beyond it has diverged.
//
//   v <= max(a U, a (|V| + |Omega| r), a v_0, a v_g, v_i),   v_g = sqrt(2 g L) in a mesh, g t without one
//
// U: speed of the water, m/s; V, Omega, r: velocity of a wall, its rotation and its farthest point; v_0: speed of the rags at the start;
// g: gravity; L: diagonal of the mesh, m; t: time, s; v_i: the impact speed that contacts are resolved to, m/s. a: DivergenceBounds::speed.
#include <string>

#include "coupling/prescribed_field.hpp"
#include "dem/rag_system.hpp"
#include "dem/walls/walls.hpp"
#include "mesh/mesh.hpp"
#include "solver/flow_solver.hpp"

namespace snag {

/// Of one step.
struct SpeedBound {
  double speed = 0;    // m/s
  std::string reason;  // where it comes from
};

class SpeedBounds {
 public:
  /// `gravity` in m/s2; `mesh` may be null. Collective.
  SpeedBounds(double gravity, const Mesh* mesh, const WallSet& walls, const std::vector<RagPiece>& pieces, double impact_speed);

  /// Largest speed of what is not water, m/s, and what it is.
  double speed() const { return speed_; }
  const std::string& source() const { return source_; }
  /// Something else moves with this speed, m/s.
  void widen(double speed, const std::string& source);
  /// At a time, in water that is computed, prescribed or absent (null). Collective.
  SpeedBound at(double time, const FlowSolver* water, const PrescribedFlow* prescribed, const RagSystem& rags) const;

 private:
  double gravity_, speed_ = 0, impact_speed_;  // m/s2, m/s, m/s
  bool falls_freely_;                          // without a mesh there is no end to it
  std::string source_ = "nothing moves";
};

/// Throws Error(diverged) for the fastest particle beyond the bound, the same on every rank. Collective.
void check_speeds(const RagSystem& rags, const SpeedBound& bound);

}  // namespace snag
