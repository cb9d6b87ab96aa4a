// snag bench flow [--peer] --out DIR
#include <CLI/CLI.hpp>
#include <memory>

#include "app/bench/dem.hpp"
#include "app/bench/flow.hpp"
#include "app/command.hpp"

namespace snag {

Action add_bench(CLI::App& app) {
  struct Options : FlowBenchOptions {
    std::string target;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "bench", "Time Snag on this machine, on the ranks it is started on; writes bench.json. flow: a sliding step of a pump");
  command->add_option("WHAT", options->target, "What to time: flow")->required();
  command->add_option("--out", options->out, "Output folder (default results/bench-flow); a mesh that is there is used again");
  command->add_flag("--peer", options->peer, "Time OpenFOAM too, on the same mesh and ranks (Debian package openfoam)");
  command->add_option("--level", options->level, "Mesh: coarse (30 thousand cells) or medium (200 thousand, default)");
  command->add_option("--steps", options->n_steps, "Steps that are timed (default 8)");
  return [options] {
    if (options->target == "dem") return bench_dem({.out = options->out, .peer = options->peer});
    if (options->target != "flow")
      throw Error(ExitCode::usage, "snag bench " + options->target + ": there is no such benchmark; there is: flow");
    return bench_flow(*options);
  };
}

}  // namespace snag
