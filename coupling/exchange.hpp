#pragma once
// The reaction of the particles in one step is spread to the water, with the weights by which they sampled it:
//
//   f_c = 1/V_c sum_b w_bc (-J_b/dt)      so that  sum_b J_b + dt sum_c V_c f_c = 0
//
// The first step of a run is Euler's, the next are BDF2, whose momentum is (3 u^n - u^(n-1))/2: with u^0 as it was, these would make half
// of what the rags gave in the first step once more,
//
//   rho (3 u^n - u^(n-1))/2 = rho (3 u^1 - u^0)/2 + dt (f^2 + ... + f^n) = rho u^0 + dt (3/2 f^1 + f^2 + ... + f^n)
//
// u^0 <- u^0 + dt f^1/rho for the steps that follow makes it rho u^0 + dt (f^1 + f^2 + ... + f^n).
#include "coupling/kernel.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

/// What this rank's particles give to the water in one step.
struct ParticleAmounts {
  std::span<const double> volume;  // m3
  std::span<const double> screen;  // FluidLoad::screen, m2
  std::span<const Vec3> impulse;   // J, N s
};

/// What was exchanged in one step; sums over all ranks.
struct ExchangeBalance {
  Vec3 on_rags, on_water;         // N s
  double exchanged = 0;           // sum of |impulse| over the particles, N s
  double max_solid_fraction = 0;  // of all cells, not clipped, 1
  double relative() const { return exchanged > 0 ? norm(on_rags + on_water) / exchanged : 0; }
};

class Exchange {
 public:
  /// `two_way`: with reaction; `screens`: with screens. The flow gets both fields of rags, zero until spread().
  Exchange(const Kernel& kernel, Flow& flow, bool two_way, bool screens);

  /// Sets solid fraction, screens and reaction of the flow from what the particles give over the step dt (s), and returns what was
  /// exchanged, for check_momentum. Collective.
  ExchangeBalance spread(const ParticleAmounts& amounts, double dt);
  /// After the first step, of dt: takes what it gave to the water into the velocity before it. Collective.
  void settle_first_step(double dt);

 private:
  const Kernel& kernel_;
  Flow& flow_;
  bool two_way_, screens_;
};

/// Throws Error(invariant) unless momentum is balanced to 1e-10 of what was exchanged. The same on every rank.
void check_momentum(const ExchangeBalance& balance);

}  // namespace snag
