#pragma once
// The competitor without physics: at each operating point and observable an unknown smooth deviation from the base model, a Gaussian
// process in time. It wins where something is missing that no candidate is like.
//
//   y - f0 ~ N(J nu, C + K),   K = (s L)^2 g(t) g(t') exp(-(t - t')^2 / 2 l^2),   g = 1 or t/T
//
// s: amplitude by observable, over the range L of the motion of the base model; l: length. Both from a grid, each choice with its share of
// the prior. f0 and J are taken where the inputs nu are likeliest under the process.
#include "diagnosis/fitting/fit.hpp"

namespace snag {

struct Discrepancy {
  double log_evidence = 0;
  std::size_t shape = 0;            // index in discrepancy_shapes
  std::vector<double> amplitude{};  // by observable, relative to its range, and of all spreads between replicates; 0: nothing there
  Eigen::VectorXd nuisances{};      // the likeliest, in standard uncertainties
};

/// `none`: the fit of no effect.
Discrepancy fit_discrepancy(const Responses& model, Fitter& fitter, const Fit& none);

}  // namespace snag
