#pragma once
// The reaction of the particles in one step is spread to the water, with the weights by which they sampled it:
//
//   f_c = 1/V_c sum_b w_bc (-I_b/dt)      so that  sum_b I_b + dt sum_c V_c f_c = 0
//
// The equations of the water hold at the end of the step, J_b/dt is the mean over the step. I_b is J_b/dt extrapolated to the end,
//
//   I_b = now J_b - older J_b^old,      3/2 J_b - 1/2 J_b^old for equal steps, J_b in the first, Euler's (TimeScheme)
//
// With J_b itself the water would lag behind by half a step: a wave of a cloth that swings with w gained energy, as with the damping ratio
// -w dt/4. As now + old + older = 0, water that nothing else drives has lost the sum of all J at the end of each step, whatever the steps:
//
//   rho V u^n = rho V u^0 - (J^1 + ... + J^n)
//
// A piece that leaves the domain, and a run that goes on from the water of another without its rags, leave older/now of the last impulse
// in the water.
#include "coupling/kernel.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

/// What this rank's particles give to the water in one step.
struct ParticleAmounts {
  std::span<const double> volume;  // m3
  std::span<const double> screen;  // FluidLoad::screen, m2
  std::span<const Vec3> given;     // I, N s
};

/// What was exchanged in one step; sums over all ranks.
struct ExchangeBalance {
  Vec3 on_rags, on_water;         // of I, N s
  double exchanged = 0;           // sum of |I| over the particles, N s
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

 private:
  const Kernel& kernel_;
  Flow& flow_;
  bool two_way_, screens_;
};

/// Throws Error(invariant) unless momentum is balanced to 1e-10 of what was exchanged. The same on every rank.
void check_momentum(const ExchangeBalance& balance);

}  // namespace snag
