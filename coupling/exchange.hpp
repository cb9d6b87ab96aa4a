#pragma once
// The reaction of the particles in one step is spread to the water, with the weights by which they sampled it:
//
//   f_c = 1/V_c sum_b w_bc (-J_b/dt)      so that  sum_b J_b + dt sum_c V_c f_c = 0
#include "coupling/kernel.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

/// What was exchanged in one step; sums over all ranks.
struct ExchangeBalance {
  Vec3 on_rags, on_water;  // N s
  double exchanged = 0;    // sum of |impulse| over the particles, N s
  double relative() const { return exchanged > 0 ? norm(on_rags + on_water) / exchanged : 0; }
};

class Exchange {
 public:
  Exchange(const Kernel& kernel, Flow& flow) : kernel_(kernel), flow_(flow) {}

  /// Sets the solid fraction of the flow from the volumes of the particles (m3); not clipped: returns the maximum over all cells.
  /// Collective.
  double spread_volumes(std::span<const double> volumes);
  /// Sets the screens of the flow from those of the particles (FluidLoad::screen, m2). Collective.
  void spread_screens(std::span<const double> screens);
  /// Sets the reaction of the flow from the impulses J (N s) of this rank's particles over the step dt, and returns what was exchanged, for
  /// check_momentum. Collective.
  ExchangeBalance spread_reaction(std::span<const Vec3> impulse, double dt);

 private:
  const Kernel& kernel_;
  Flow& flow_;
};

/// Throws Error(invariant) unless momentum is balanced to 1e-10 of what was exchanged. The same on every rank.
void check_momentum(const ExchangeBalance& balance);

}  // namespace snag
