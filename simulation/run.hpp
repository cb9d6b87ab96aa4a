#pragma once
// A run from the case file to its results. It writes no page: whoever starts it says how the report is made.
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "simulation/output/report_writer.hpp"

namespace snag {

struct Prepared;

struct RunOptions {
  std::filesystem::path case_file;
  std::filesystem::path out;           // empty: results/NAME
  std::vector<std::string> overrides;  // --set
  bool resume = false, overwrite = false;
  ReportWriter write_report{};   // at the end, unless [output] report = false; empty: no report
  Prepared* prepared = nullptr;  // of runs that share it
};

/// Run a case to its end, or to a request to stop. Collective over all ranks.
ExitCode run_case(const RunOptions& options);

/// Everything short of a time step: schema, mesh, conditions, stable steps, kernel and cells, cost. Collective over all ranks.
ExitCode check_case(const RunOptions& options);

}  // namespace snag
