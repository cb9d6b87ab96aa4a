#pragma once
// How the water at a particle answers to forces within one step of the flow, before the flow solver knows of them.
//
// The flow's step with its time scheme (now, old, older) is   (now u^(n+1) + old u^n + older u^(n-1))/dt = r + f/rho.   With the same
// equation of the step before, all that moved the water but the rags, r, is known in every cell, so that
//
//   change:    u* - u^n,   u* = (dt r - old u^n - older u^(n-1))/now       without any force of the rags in this step
//   response:  d_b = (A S^T 1)_b/(now rho)                                 lost velocity per impulse of the particle, 1/kg
//
// A: average to the particles, S^T: spreading to the cells (coupling/kernel.hpp). 1/d_b is the mass of the water that a particle shares
// with its neighbours: 44.5 rho delta^3 for one alone, 3.54 rho delta times the area of a particle in a flat sheet. Particles that feel
// u^n + (u* - u^n) t/dt - d_b J_b(t), J_b the impulse up to then, and give J_b to the water, are stable for any resistance, kernel and
// step: A S^T is symmetric without negative entries, so that its sums of rows bound it, and the pressure of the flow takes away
// from the answer only. A steady state does not depend on d_b.
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
