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

/// True if an effect of a hypothesis is seen somewhere beside the others: a cell (observable, third of the time, point) where the fit
/// without it leaves a mean residual of more than 3 and the whole one less; or an observable where what the whole one takes away stands out
/// from the residual without it by more than 3, at one point or over all of them; or the inputs, which are far off without it.
bool has_cell_of_its_own(const Responses& model, const Fit& whole, const Fit& without);

}  // namespace snag
