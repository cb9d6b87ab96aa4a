#pragma once
// snag diagnose --bench: sealed twins, each diagnosed blind, and the score card.
#include <filesystem>
#include <vector>

#include "benchmark/blind/twin.hpp"
#include "diagnosis/score/score.hpp"

namespace snag {

struct DiagnoseBenchOptions : TwinPlan {
  int n = 60;
  std::filesystem::path out;
};

/// Rows and their scores; they count on rank 0.
struct BlindScores {
  std::vector<ScoreRow> rows;
  ScoreCard card;
};

/// Makes and judges n sets, in DIR/sets and DIR/sealed; a row of DIR/rows.csv each as they come, those that are there are not done again;
/// then DIR/score.json. Collective; throws Error.
BlindScores bench_diagnosis(const DiagnoseBenchOptions& options);

}  // namespace snag
