#pragma once
// The measurement that would separate two hypotheses best: Hunter and Reiner's T, the squared difference of their predictions over the
// covariance of one more replicate and of the inputs. Where no effect explains the data: where to look.
#include <string>

#include "diagnosis/attribution/attribution.hpp"

namespace snag {

/// In a sentence: which observable at which point and when, and how many replicates; empty where there is nothing to separate.
std::string next_experiment(const Responses& model, const Attribution& attribution, bool unexplained);

}  // namespace snag
