#pragma once
// Prediction of the water at a particle within one step of the flow, before the flow solver makes the step.
//
// The time scheme (now, old, older) of the flow gives   (now u^(n+1) + old u^n + older u^(n-1))/dt = r + f/rho.   f is the reaction of the
// rags; r is everything else that changes the velocity. The last step gives r and f in every cell, and with them
//
//   u* = (dt R r - old u^n - older u^(n-1))/now                       velocity at the end of the step without a force of the rags
//   change:        u* - u^n - G (R - 1) x_c                           at the place where the cell is at the start of the step
//   acceleration:  (change + dt R f/(now rho))/dt + G u^n             Du/Dt, with the force of the rags of the last step
//   response:      d_b = (A S^T 1)_b/(now rho)                        velocity that the water loses per impulse of the particle, 1/kg
//
// R turns by the angle of the step in a zone that turns (x_c from its axis), so that water that turns with its zone is predicted exactly;
// elsewhere R = 1. In the first step the water counts as steady, in a turning zone as seen from it. G: velocity gradient. A averages to the
// particles, S^T spreads to the cells (coupling/kernel.hpp). 1/(now d_b) is the mass of water that a particle shares with its neighbours:
// 44.5 rho delta^3 for a particle by itself, 3.54 rho delta per area of cloth in a flat sheet.
//
// A particle at x_b(t), t after the start of the step, feels u^n + change t/dt + G (x_b(t) - x_b(0)) - d_b J_b(t), where J_b is its impulse
// since the start of the step. Without the term of G the water would lag behind by a step: in water that turns by 3.6 degrees a step a
// neutral cloth would drift outwards with 3 % of the speed of the water. The scheme is stable for any resistance, kernel and step: A S^T is
// symmetric and has no negative entry, so that the diagonal matrix of its row sums is an upper bound of it, and the pressure of the flow
// makes the answer smaller. A steady state does not depend on d_b.
#include <vector>

#include "coupling/kernel.hpp"
#include "parallel/checkpoint.hpp"
#include "solver/fields/flow.hpp"
#include "solver/fields/time_scheme.hpp"

namespace snag {

class WaterPrediction {
 public:
  explicit WaterPrediction(const Flow& flow) : flow_(flow) {}

  /// Before a step of the flow of length dt, s: sets change() and acceleration().
  void begin_step(double dt);
  /// After that step, with the reaction it was made with.
  void end_step();
  /// Of the owned cells, m/s.
  const std::vector<Vec3>& change() const { return change_; }
  /// Of the owned cells, m/s2.
  const std::vector<Vec3>& acceleration() const { return acceleration_; }
  double dt() const { return scheme_.dt; }
  /// d at the particles of the kernel, 1/kg. Collective.
  std::vector<double> response(const Kernel& kernel) const;

  /// Collective; throws Error(io).
  void save(CheckpointWriter& writer) const;
  void load(CheckpointReader& reader);

 private:
  std::span<const std::int64_t> owned_ids() const;

  const Flow& flow_;
  TimeScheme scheme_;
  bool known_ = false;              // r: not before the first step
  std::vector<Vec3> rate_;          // r of the last step, of the owned cells, m/s2
  std::vector<Vec3> change_;        // m/s
  std::vector<Vec3> acceleration_;  // m/s2
};

}  // namespace snag
