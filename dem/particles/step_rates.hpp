#pragma once
// What a step of leapfrog with springs and dashpots has to resolve (velocities of the dashpots lag half a step):
//
//   dt^2/4 K + dt/2 C + S < 1      K, C: largest eigenvalues of stiffness and damping over mass or moment of inertia
//                                  S: the same of dt/2 C for dashpots that are eased, so that it does not grow with the step
//
// It bounds the largest eigenvalue of the sum, so that parts may be added: those of bonds, of the contacts of a particle, of drag.
//
//   dt = 2 s/(c + sqrt(c^2 + K s)),  c = C/2,  s = 1 - S
#include <algorithm>
#include <cmath>

namespace snag {

struct StepRates {
  double stiffness = 0;  // K, 1/s2
  double damping = 0;    // C, 1/s
  double share = 0;      // S, 1

  /// Largest stable step, s; infinite without rates.
  double step() const {
    constexpr double least_rest = 0.1;  // S is an upper bound, which falls with the step
    const double c = 0.5 * damping, rest = std::max(1 - share, least_rest);
    return 2 * rest / (c + std::sqrt(c * c + stiffness * rest));
  }

  StepRates operator+(const StepRates& r) const { return {stiffness + r.stiffness, damping + r.damping, share + r.share}; }
  friend StepRates operator*(double factor, const StepRates& r) { return {factor * r.stiffness, factor * r.damping, factor * r.share}; }
};

/// Rates not smaller than either.
inline StepRates largest(const StepRates& a, const StepRates& b) {
  return {std::max(a.stiffness, b.stiffness), std::max(a.damping, b.damping), std::max(a.share, b.share)};
}

}  // namespace snag
