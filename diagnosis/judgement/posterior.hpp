#pragma once
// Draws from the posterior of one fitted hypothesis: the strengths of its effects and the deviations of the inputs, jointly.
//
//   d ~ N(m, S) with lower <= d_e <= upper for the strengths,   S = (J^T J + 1)^-1,   m = -S (J^T rho - prior)
//   theta_e = fitted strength + sd (d_e - d_fit)/sqrt(S_ee)
//
// rho, J: residual and derivative at the fit (fit.hpp); so this is the Laplace approximation on which the evidence rests. What is there or
// not has no strength and is no variable; forms of laws are integrated out.
// Draws within bounds: one variable after the other from its truncated normal distribution given those before, each draw weighted with the
// masses within the bounds and resampled by the weights; without an active bound the draws are independent and exact.
// Source: Geweke (1991), Computing Science and Statistics 23, 571-578 (the GHK sampler, used here with resampling).
#include "diagnosis/data/posterior_draws.hpp"
#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// Draws of d, one a column.
Eigen::MatrixXd posterior_of(const LinearModel& linear, int n, std::uint64_t seed);

/// `name`: of the hypothesis.
PosteriorDraws posterior_draws(const Responses& model, const Fit& fit, const std::string& name, std::uint64_t seed);

}  // namespace snag
