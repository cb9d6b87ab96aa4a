#pragma once
// snag bench flow: seconds of a sliding time step of a pump, beside what memory bandwidth allows and beside another program.
#include <filesystem>
#include <string>

#include "base/error.hpp"

namespace snag {

struct FlowBenchOptions {
  std::filesystem::path out = "results/bench-flow";
  std::string level = "medium";  // of the mesh: coarse, 30 thousand cells; medium, 200 thousand
  int n_steps = 8;               // timed
  bool peer = false;
};

/// Writes bench.json to the output folder and prints it as a table. Collective; throws Error.
ExitCode bench_flow(const FlowBenchOptions& options);

}  // namespace snag
