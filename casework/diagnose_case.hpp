#pragma once
// From DIAGNOSIS.toml to the verdict; pages are written by the command.
#include <filesystem>
#include <string>

#include "diagnosis/data/verdict.hpp"

namespace snag {

struct DiagnoseOptions {
  std::filesystem::path file, out;
  bool keep_runs = true;  // in DIR/runs.tsv and DIR/runs, to go on from after a stop
  bool quiet = false;
};

/// Reads the experiment, runs and judges; writes verdict.json, posterior.json and the improved cases. Collective; throws Error.
Verdict diagnose_file(const DiagnoseOptions& options);

}  // namespace snag
