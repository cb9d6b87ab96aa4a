#pragma once
// snag bench coupling: what it costs to couple cloth and water, beside the water and the cloth alone.
#include <filesystem>

#include "base/error.hpp"

namespace snag {

struct CouplingBenchOptions {
  std::filesystem::path out = "results/bench-coupling";
  int n_steps = 8;     // timed, of each kernel
  bool peer = false;   // there is none, which a warning says
  bool quick = false;  // a quarter of the particles and cells
};

/// Writes bench.json to the output folder and prints it as a table. Collective; throws Error.
ExitCode bench_coupling(const CouplingBenchOptions& options);

}  // namespace snag
