#pragma once
// From weights, checks and guards to fixed words.
#include "diagnosis/attribution/attribution.hpp"
#include "diagnosis/data/verdict.hpp"

namespace snag {

/// Fills the verdict's words, probabilities, parameters, checks and notes. Returns the index of the fit that the verdict rests on.
int judge(const Responses& model, Attribution& attribution, Verdict& verdict);

/// No effect is named that does not shrink the gap at the withheld points, where they show one: the verdict is then a tie with outside.
void withdraw_what_shrinks_nothing(Verdict& verdict);

}  // namespace snag
