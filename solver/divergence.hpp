#pragma once
// Divergence of the water, found while its numbers are still finite.
//
//   U = max(tip speed of the rotor, speeds given at patches, sqrt(2 (dp + |f| L)/rho), sqrt(k) where it is given, rms of the velocity at
//           the start, speed of bodies in the water, sum dt |f + mean force by rags|/rho)
//   |u| <= a U,   sqrt(k) <= a U,   C <= a C_U,   p_max - p_min <= rho (a U)^2/2 + rho U L/dt + 12 mu a U L/h^2
//   V_lost <= b V,   momentum is solved in one step of N at least, k and epsilon in one of the last N
//
// U: speed of the case, m/s. dp: range of the pressures given at patches, Pa. f: body force, N/m3. L: diagonal of the domain, m. C: Courant
// number of a cell; C_U: that with the speed U through all its faces. rho U L/dt: impulsive start; 12 mu a U L/h^2: creep in a gap of the
// least cell size h. V_lost: net volume that leaves a cell of volume V in a step. The bounds are far outside of what water does: they say
// nothing of accuracy.
#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "solver/boundaries/boundary.hpp"
#include "solver/flow_settings.hpp"

namespace snag {

class CheckpointReader;
class CheckpointWriter;
struct StepReport;

/// Bounds on the water, all without unit.
struct DivergenceBounds {
  /// a: pumps stay below 0.5, their impulsive starts below 2; a gap may be narrower than any patch.
  static constexpr double speed = 20;
  /// b: a pressure equation that is solved leaves less than 1e-3.
  static constexpr double lost_volume = 0.1;
  /// Residual over the right-hand side above which an equation that used up its sweeps counts as not solved.
  static constexpr double residual = 1e-3;
  /// N, consecutive.
  static constexpr int unsolved_steps = 20;
};

/// Volume through the faces of a cell, [n_all_cells], m3/s: net out of it, and the sum of the magnitudes relative to the mesh.
struct CellFluxes {
  std::span<double> net, through;
};

class DivergenceWatch {
 public:
  /// Collective, as are the functions below unless they say local.
  DivergenceWatch(const Mesh& mesh, const FlowSettings& settings);

  /// Scales of the start: velocity and k at its begin.
  void begin(const Flow& flow);
  /// Scales of what patches and the rotor will give until `end`, s. The conditions are left as they are.
  void foresee(const Flow& flow, BoundarySet& boundary, double end);
  /// Bodies in the water move with up to `speed`, m/s; `what` for messages. The same on every rank, local.
  void widen(double speed, const std::string& what);
  /// After a step. Throws Error(diverged), the same on every rank, with cell, place, quality, time and advice.
  void check(const Flow& flow, const BoundarySet& boundary, const CellFluxes& fluxes, const StepReport& report);
  /// Throws Error(diverged) for the step that is being made: `what` names the equation that has no solution.
  [[noreturn]] void fail(const Flow& flow, const BoundarySet& boundary, double dt, const std::string& what) const;

  /// Speed of the case so far, m/s, and what sets it.
  double speed() const { return speed_; }
  const std::string& source() const { return source_; }
  /// Courant number of each cell with water of that speed through all its faces, [n_cells]. Local.
  std::vector<double> courant_of(double dt) const;
  /// Of the whole run: the fastest water over the speed of the case.
  double largest_speed_ratio() const { return largest_ratio_; }
  /// Consecutive steps whose equations were not solved: the most of momentum, the last of k and epsilon (raised: unsolved), which may
  /// recover.
  int unsolved_steps() const { return std::max(most_unsolved_, unsolved_turbulence_); }

  /// A warning where the water of a cell is faster than the case and 1.5 times as fast as all cells around it; empty if none is. The same
  /// on every rank.
  std::string lone_cell(const Flow& flow) const;

  void save(CheckpointWriter& checkpoint) const;
  void load(CheckpointReader& checkpoint);

 private:
  struct Finding;
  void see_conditions(const Flow& flow, const BoundarySet& boundary, double time);
  void see_forces(const Flow& flow);
  Finding worst(const Flow& flow, double dt, const CellFluxes* fluxes) const;
  void count_unsolved(const Flow& flow, const BoundarySet& boundary, const StepReport& report);
  std::string fault_of_opening(const Flow& flow, const BoundarySet& boundary, const Finding& found) const;
  std::string cell_in_words(const Finding& found) const;
  std::string advice(const Flow& flow, const Finding& found, double dt) const;
  [[noreturn]] void throw_at(const Flow& flow, const BoundarySet& boundary, double dt, const Finding& found, const std::string& what) const;

  const Mesh& mesh_;
  FlowSettings settings_;
  std::vector<float> area_;  // of all faces of a cell, [n_all_cells], m2
  double length_ = 0;        // L, m
  double tip_radius_ = 0;    // of the turning zone, m
  double speed_ = 0;         // U, m/s
  double gained_speed_ = 0;  // by forces, m/s
  std::string source_ = "nothing moves";
  double largest_ratio_ = 0;
  int unsolved_ = 0, most_unsolved_ = 0, unsolved_turbulence_ = 0;
};

}  // namespace snag
