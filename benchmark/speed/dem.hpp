#pragma once
// snag bench dem: particle-steps a second of the cloth, beside what the machine allows and beside other programs.
#include <filesystem>

#include "base/error.hpp"

namespace snag {

struct DemBenchOptions {
  std::filesystem::path out = "results/bench-dem";
  bool peer = false;
  bool quick = false;  // a few steps of the small cases
};

/// Writes bench.json to the output folder and prints it as a table. Collective; throws Error.
ExitCode bench_dem(const DemBenchOptions& options);

}  // namespace snag
