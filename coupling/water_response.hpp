#pragma once
// Prediction of the water at a particle within one step of the flow, before the flow solver makes the step.
//
// The time scheme (now, old, older) of the flow gives   (now u^(n+1) + old u^n + older u^(n-1))/dt = r + f/rho.   f is the reaction of the
// rags; r is everything else that changes the velocity. The last step gives r in every cell, and with it
//
//   change:    u* - u^n,   u* = (dt r - old u^n - older u^(n-1))/now       velocity at the end of the step without a force of the rags
//   response:  d_b = (A S^T 1)_b/(now rho)                                 velocity that the water loses per impulse of the particle, 1/kg
//
// A averages to the particles, S^T spreads to the cells (coupling/kernel.hpp). 1/(now d_b) is the mass of water that a particle shares with
// its neighbours: 44.5 rho delta^3 for a particle by itself, 3.54 rho delta per area of cloth in a flat sheet.
//
// A particle feels u^n + (u* - u^n) t/dt - d_b J_b(t), where J_b is its impulse since the start of the step. The scheme is stable for any
// resistance, kernel and step: A S^T is symmetric and has no negative entry, so that the diagonal matrix of its row sums is an upper bound
// of it, and the pressure of the flow makes the answer smaller. A steady state does not depend on d_b.
#include <vector>

#include "coupling/kernel.hpp"
#include "parallel/checkpoint.hpp"
#include "solver/fields/flow.hpp"
#include "solver/fields/time_scheme.hpp"

namespace snag {

class WaterResponse {
 public:
  explicit WaterResponse(const Flow& flow) : flow_(flow) {}

  /// Before a step of the flow of length dt, s: sets change().
  void begin_step(double dt);
  /// After that step, with the reaction it was made with.
  void end_step();
  /// u* - u^n at the place where a cell is at the start of the step, of the owned cells, m/s.
  const std::vector<Vec3>& change() const { return change_; }
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
  bool known_ = false;        // r: not before the first step
  std::vector<Vec3> rate_;    // r of the last step, of the owned cells, m/s2
  std::vector<Vec3> change_;  // m/s
};

}  // namespace snag
