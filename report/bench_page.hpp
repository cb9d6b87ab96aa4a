#pragma once
// The score card for people.
#include <string>
#include <vector>

#include "diagnosis/score/score.hpp"

namespace snag {

/// Lines for the terminal.
std::string card_text(const ScoreCard& card);
/// report.html: scores with their targets, reliability diagram, confusion matrix, hits over the size of the gap.
std::string bench_page(const std::string& title, const std::vector<ScoreRow>& rows, const ScoreCard& card);

}  // namespace snag
