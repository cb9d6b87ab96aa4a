#pragma once
// Prediction of the water at a particle within one step of the flow, before the flow solver makes the step.
//
// The time scheme (now, old, older) of the flow gives   (now u^(n+1) + old u^n + older u^(n-1))/dt = r + f/rho.   f is the reaction of the
// rags; r is everything else that changes the velocity. The last step gives r and f in every cell, and with them
//
//   u* = (dt R r - old u^n - older u^(n-1))/now                       velocity at the end of the step without a force of the rags
//   change:        u* - u^n - G (R - 1) x_c                           at the place where the cell is at the start of the step
//   acceleration:  (change + dt R f/(now rho))/dt + G u^n             Du/Dt, with the force of the rags of the last step
//   response:      d_b = (A S^T 1)_b/rho                              velocity that the water loses per impulse of the particle, 1/kg
//
// R turns by the angle of the step in a zone that turns (x_c from its axis), so that water that turns with its zone is predicted exactly;
// elsewhere R = 1. In the first step the water counts as steady, in a turning zone as seen from it. G: velocity gradient. A averages to the
// particles, S^T spreads to the cells (coupling/kernel.hpp). 1/d_b is the mass of water that a particle shares with its
// neighbours: 44.5 rho delta^3 for a particle by itself, 3.54 rho delta per area of cloth in a flat sheet.
//
// The water is given I = now J - older J^old (coupling/exchange.hpp). A particle at x_b(t), t after the start of the step, feels
//
//   u^n + (change/dt + e_b + older/now d_b J_b^old/dt) t + G (x_b(t) - x_b(0)) - d_b J_b(t)
//
// where J_b is its impulse since the start of the step. Without the term of G the water would lag behind by a step: in water that turns
// by 3.6 degrees a step a neutral cloth would drift outwards with 3 % of the speed of the water. The scheme is stable for any resistance,
// kernel and step: A S^T is symmetric and has no negative entry, so that the diagonal matrix of its row sums is an upper bound of it, and
// the pressure of the flow makes the answer smaller.
//
// e_b is what the answers of the last step were missed by: the flow shares f among cells side by side (f~, solver/continuity.hpp), and
// d_b I_b is (A S^T I)_b/rho only where neighbours have the same impulse.
//
//   e_b = s_b F(m),   m = (d_b I_b/dt + A f~/rho)/now,   F(m) = A R S^T m / (A S^T 1)
//
// In a steady flow change + A f~ dt/(now rho) = 0, so that with e = m the particle feels u^n during the whole step, and the law of its drag
// holds for the velocity that the flow has, whatever d_b and the step. F keeps modes of the impulses small that the flow hardly answers to.
// For a mode with l times the predicted answer, u' = (1 - l) u - l e and e' = F (1 - l)(u + e) (implicit Euler, no pressure), so that
//
//   mu^2 - (1 - l)(1 + F) mu + F (1 - l) = 0
//
// is within the unit circle for 0 < l <= 1. A f~ is not symmetric on tetrahedra: with F = |l|, as the average with the kernel is, complex
// l are stable too (up to 45 degrees where |l| <= 0.6); with F = 1 those of small |l| grow from 10 degrees on.
//
// u^n is the velocity of the fluxes. The velocity of a cell answers to the force and to the pressure in it, which cancel to the order of
// the cell only: in a cloth that holds a pressure of many rho u^2 its error is larger than the velocity of the water that passes, and has
// the same sign in the mean. What the faces carry is free of that error. For a velocity that is linear in space, u = u_c + G (x - x_c), and
// faces f with the flux out of the cell phi_f,
//
//   u_c = 1/V_c sum_f (x_f - x_c) (phi_f - S_f . G (x_f - x_c)),   x_c across the period where f joins two sides of it
//
// s_c = 8 delta/V_c^(1/3) - 3, within 0 and 1: a kernel narrower than 3/8 of a cell reads single cells, where neither the fluxes (a force
// in one tetrahedron moves its own faces more than predicted) nor e are steady. There u_c is that of the cell, and e is zero.
#include <vector>

#include "coupling/kernel.hpp"
#include "parallel/checkpoint.hpp"
#include "solver/fields/flow.hpp"
#include "solver/fields/time_scheme.hpp"

namespace snag {

class WaterPrediction {
 public:
  /// `kernel_width`: delta, m; 0 for a kernel without a width.
  WaterPrediction(const Flow& flow, double kernel_width);

  /// s_c of the cells, [n_cells].
  const std::vector<double>& resolved() const { return resolved_; }
  /// Before a step of the flow of length dt, s.
  void begin_step(double dt);
  /// Sets velocity(), change() and acceleration() of these owned cells for that step, before the mesh turns in it.
  void predict(std::span<const int> cells);
  /// After that step, with the reaction it was made with.
  void end_step();
  /// u^n, [owned cells], m/s.
  const std::vector<Vec3>& velocity() const { return velocity_; }
  /// [owned cells], m/s.
  const std::vector<Vec3>& change() const { return change_; }
  /// [owned cells], m/s2.
  const std::vector<Vec3>& acceleration() const { return acceleration_; }
  double dt() const { return scheme_.dt; }
  /// Of the step.
  const TimeScheme& scheme() const { return scheme_; }
  /// Times d and the impulse of the last step: the rate of what is left of the answer to it, 1/s.
  double response_left() const { return scheme_.older / (scheme_.now * scheme_.dt); }
  /// d at the particles of the kernel, 1/kg. Collective.
  std::vector<double> response(const Kernel& kernel) const;
  /// e of the next step at the particles of the kernel, m/s2, after a step and with the weights it was made with. `response`: d, 1/kg;
  /// `given`: I, N s, of that step. Collective.
  std::vector<Vec3> missed_rates(const Kernel& kernel, std::span<const double> response, std::span<const Vec3> given) const;

  /// Collective; throws Error(io).
  void save(CheckpointWriter& writer) const;
  void load(CheckpointReader& reader);

 private:
  std::span<const std::int64_t> owned_ids() const;
  Vec3 start_velocity(int cell) const;
  Vec3 turned(int cell, const Vec3& v) const;

  const Flow& flow_;
  std::vector<double> resolved_;  // s, of the owned cells
  TimeScheme scheme_;
  Mat3 turn_;                       // R of the step
  bool known_ = false;              // r: not before the first step
  bool resumed_ = false;            // u^n is that of a checkpoint: its fluxes of the sliding interface are not kept
  std::vector<Vec3> rate_;          // r of the last step, of the owned cells, m/s2
  std::vector<Vec3> velocity_;      // u^n, m/s
  std::vector<char> is_settled_;    // u^n is that of the fluxes: for good where the flow is frozen
  std::vector<Vec3> change_;        // m/s
  std::vector<Vec3> acceleration_;  // m/s2
};

}  // namespace snag
