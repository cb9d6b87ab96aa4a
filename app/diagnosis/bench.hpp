#pragma once
// snag diagnose --bench: sealed twins, each diagnosed blind, and the score card.
#include <filesystem>

#include "app/diagnosis/twin.hpp"

namespace snag {

struct DiagnoseBenchOptions : TwinPlan {
  int n = 60;
  std::filesystem::path out;
};

/// Makes and judges n sets, in DIR/sets and DIR/sealed; a row of DIR/rows.csv each as they come, those that are there are not done again;
/// then DIR/score.json and DIR/report.html. Collective; throws Error.
void bench_diagnosis(const DiagnoseBenchOptions& options);

}  // namespace snag
