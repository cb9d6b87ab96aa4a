#pragma once
// Does the chosen hypothesis describe the data at all? Posterior predictive checks of its whitened residuals, and guards on its strengths.
#include <cstdint>
#include <vector>

#include "diagnosis/data/verdict.hpp"
#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// chi2, lag-1 autocorrelation, max |z| and energy distance of the residuals at the fit against what the fitted model would give: residuals
/// are N(0, 1 - J (J^T J + 1)^-1 J^T) where it holds.
std::vector<PredictiveCheck> predictive_checks(const Responses& model, const Fit& fit, std::uint64_t seed);

/// Strength of each effect of a fit with its estimates by operating point and Cochran's test that these agree.
std::vector<EffectEstimate> estimates(const Responses& model, const Fit& fit);

}  // namespace snag
