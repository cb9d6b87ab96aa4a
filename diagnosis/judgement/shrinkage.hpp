#pragma once
// How far the gap shrinks on operating points that were withheld from the fit:
//
//   G = max(0, mean over the rows of the withheld points of (E^2 - u_noise^2)/u_D^2),   shrinkage = 1 - G_after/G_before
//
// E: model minus data after the inputs of the withheld point were fitted to it within their priors (after: shared nuisances within what
// the training points left open): a gap is what lies outside their band. u_noise^2: what E^2 is when nothing is missing. Before: the base
// model. After: the same with the effect as the training points have it. Shrinkage alone never proves a cause.
#include "diagnosis/attribution/attribution.hpp"
#include "diagnosis/data/verdict.hpp"

namespace snag {

/// Fills the four bars and the shrinkage of the chosen fit, of the rejected ones and of a regression without physics.
void measure_shrinkage(Responses& model, const Attribution& attribution, int chosen, Verdict& verdict);

}  // namespace snag
