#pragma once
// Fit of an effect that is random: it shows in the mean and in the spread over replicates and seeds, not path by path. Its strength
// changes the covariance, so the evidence is a sum over strengths instead of a Laplace approximation.
#include "diagnosis/fit.hpp"

namespace snag {

/// Fit of one random effect alone; the nuisances are linear around the base model. The fit's linear model holds the nuisances only.
Fit fit_random_effect(Responses& model, Fitter& fitter, int effect);

}  // namespace snag
