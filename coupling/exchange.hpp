#pragma once
// Both ways of the coupling over one step of the flow: what the particles took is given to the water, with the same weights.
//
//   given:     f_c = 1/V_c sum_b w_bc (-J_b/dt) + beta_c u_c^n,    beta_c = 1/V_c sum_b w_bc Q_b/dt
//   applied:   f_c - beta_c u_c^(n+1)                              by the solver, with its final velocity
//   settled:   dJ_b = Q_b sum_c w_bc (u_c^(n+1) - u_c^n)           drag that the water felt beyond -J_b, kicked to the particle
//
// so that  sum_b (J_b + dJ_b) + dt sum_c V_c (f_c - beta_c u_c^(n+1)) = 0  to round-off, and the drag is implicit in the flow: any dt is
// stable. For Q_b above the particle's mass the exchange lags by about Q_b/m_b steps (still stable, still conservative): the stiffness is
// monitored.
#include "coupling/kernel.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

/// What was exchanged in one step; sums over all ranks.
struct ExchangeBalance {
  Vec3 on_rags, on_water;  // N s
  double exchanged = 0;    // sum of |impulse| over the particles, N s
  double round_off = 0;    // what the arithmetic of f - beta u can leave, N s
  double relative() const { return exchanged > 0 ? norm(on_rags + on_water) / exchanged : 0; }
};

class Exchange {
 public:
  Exchange(const Kernel& kernel, Flow& flow) : kernel_(kernel), flow_(flow) {}

  /// Solid fraction of particles of these volumes (m3); not clipped: returns the maximum over all cells. Collective.
  double give_volumes(std::span<const double> volumes);
  /// Sets reaction and drag of the flow from impulse J (N s) and sensitivity Q (kg) of this rank's particles over the step dt. Collective.
  void give(std::span<const Vec3> impulse, std::span<const double> sensitivity, double dt);
  /// After the flow's step: dJ of every particle, N s; added to what balance() counts. Collective.
  std::vector<Vec3> settle();
  /// What was exchanged by give() and settle(), for check_momentum. Collective.
  ExchangeBalance balance() const;
  /// Largest beta dt/rho: above 2 an explicit exchange would be unstable. Collective.
  double max_drag_number() const;

 private:
  const Kernel& kernel_;
  Flow& flow_;
  double dt_ = 0;
  std::vector<Vec3> impulse_;          // J, then J + dJ, N s
  std::vector<double> sensitivity_;    // Q, kg
  std::vector<Vec3> velocity_before_;  // u^n of the owned cells
};

/// Throws Error(invariant) unless momentum is balanced to 1e-10 of what was exchanged. The same on every rank.
void check_momentum(const ExchangeBalance& balance);

}  // namespace snag
