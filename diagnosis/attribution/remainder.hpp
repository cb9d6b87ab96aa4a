#pragma once
// What the effects of a hypothesis leave unexplained: a small discrepancy process beside them.
//
//   y - f(theta, nu) ~ N(0, C + K),   K = (s D)^2 g(t) g(t') exp(-(t - t')^2 / 2 l^2),   g = 1 or t/T
//
// D: root mean square of the gap, which the fit of no effect leaves, of quantities of one unit at a point; s: at most 0.3, so that the
// effects explain nine tenths of the square of the gap or more (a larger rest is what "outside" is for, see discrepancy.hpp); l: length, T:
// duration. s, l and g from a grid of equal shares of the prior. A hypothesis holds with and without such a remainder with equal prior
// probability. A process that takes more than half of the gap is none: beside a wrong effect it would be "outside" by another name, for the
// inputs may take up most of D.
#include <vector>

#include "diagnosis/fitting/fit.hpp"

namespace snag {

struct Remainder {
  double log_evidence = 0;  // nats that the process brings over the fit without it
  double gain = 0;          // nats that the choice between both brings: log((1 + exp(log_evidence))/2)
  double share = 0;         // of the gap that the process takes, 0 where it brings less than none; above 1/2 it is not credited
  std::vector<double> share_of_effect{};  // by effect; with `share` they sum to 1, an effect against the gap has a negative one
};

/// Of a fit with effects; of none, and where no row is Gaussian, no process brings anything. Shares are parts of the square of the gap,
///
///   share_e = p_e . P g / g . P g,   g = sum_e p_e + q,   P = 1 - J_nu (J_nu^T J_nu + 1)^-1 J_nu^T
///
/// p_e: what effect e adds, q: likeliest process, both whitened with C; P takes out what the inputs may be off by.
Remainder fit_remainder(const Responses& model, const Fit& none, const Fit& fit);

}  // namespace snag
