#pragma once
// The table of the runs of a diagnosis, runs.tsv: a line a run, with tabs between
//
//   program    the first 16 digits of its fingerprint
//   key        of the run: point and settings
//   values     at the slots of the point, with all their digits, each with a comma behind it
//   failure    empty: it ran
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/data/simulator.hpp"

namespace snag {

struct StoredRun {
  std::string program, key;
  RunResult result;
};

/// Runs of the text of a table. A last line without its end was cut off when a diagnosis was stopped, and is passed over; any other line
/// that is no run is an Error(io) with `file` and line.
std::vector<StoredRun> run_table(std::string_view text, const std::filesystem::path& file);

/// The line of a run, with its end.
std::string run_table_line(const StoredRun& run);

}  // namespace snag
