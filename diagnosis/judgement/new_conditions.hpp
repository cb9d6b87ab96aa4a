#pragma once
// Conditions that were not measured, ranked by what a test there is expected to tell two hypotheses apart by: the nats of one repeat,
//
//   T/2 = 1/2 d . C^-1 d,   d = f_a - f_b at the condition
//
// C: covariance of one repeat of an observable, and of the inputs at that condition (next_experiment.hpp). Conditions are the known inputs
// of a point, halved and doubled one by one, and ranked by nats over the cost of a test with another value of that input, in repeats
// (Experiment::costs). Runs are made for it, at most a quarter of those that the verdict took. Source: Hunter and Reiner (1965),
// Technometrics 7, 307-323.
#include <vector>

#include "diagnosis/attribution/attribution.hpp"

namespace snag {

/// The best first; none where no condition tells twice as much per cost as a repeat at the best point, or where the budget has no runs left
/// for it.
std::vector<NewCondition> new_conditions(Responses& model, const Attribution& attribution);

}  // namespace snag
