#pragma once
// A verdict in sentences: what was found, and what an engineer does about it.
#include <string>
#include <vector>

#include "diagnosis/data/verdict.hpp"

namespace snag {

/// The verdict in one sentence.
std::string verdict_sentence(const Verdict& verdict);
/// What to do now, in one sentence or two.
std::string verdict_advice(const Verdict& verdict);

/// The effects of the verdict: "added_mass and lift".
std::string effects_in_words(const Verdict& verdict);
/// What the verdict names: all causes of it, of a tie those of each hypothesis, or "none", "outside".
std::vector<std::string> names_of(const Verdict& verdict);

/// "98 %"; "-" where there is no number.
std::string share_in_words(double share);
/// A probability that rounds to one or to none is not known to be so: "over 99 %".
std::string probability_in_words(double p);
/// "point A with flow.amplitude doubled".
std::string condition_in_words(const NewCondition& condition);
/// "0.1 to 0.2 s", "whole run".
std::string window_in_words(const GapCell& cell);

}  // namespace snag
