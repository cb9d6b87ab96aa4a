// snag bench flow|dem|coupling [--peer] --out DIR
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "benchmark/speed/coupling.hpp"
#include "benchmark/speed/dem.hpp"
#include "benchmark/speed/flow.hpp"

namespace snag {

namespace {

Action add_bench(CLI::App& app) {
  struct Options : FlowBenchOptions {
    std::string target;
    std::filesystem::path folder;
    bool quick = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "bench",
      "Time Snag on this machine, on the ranks it is started on; writes bench.json. flow: a sliding step of a pump; dem: "
      "particle-steps of cloth, on one rank and on all; coupling: steps of cloth in water, by kernel");
  command->add_option("WHAT", options->target, "What to time: flow, dem, coupling")->required();
  command->add_option("--out", options->folder, "Output folder (default results/bench-WHAT); a mesh in it is used again");
  command->add_flag(
      "--peer", options->peer,
      "Time another program too: OpenFOAM on the same mesh and ranks (Debian package openfoam), LAMMPS on a sheet of the same "
      "size (Debian package lammps)");
  command->add_option("--level", options->level,
                      "flow: mesh coarse (30 thousand cells), medium (200 thousand, default) or fine (a million)");
  command->add_option("--steps", options->n_steps, "flow, coupling: steps that are timed (default 8)");
  command->add_flag("--quick", options->quick, "dem: the small cases only; coupling: a quarter of the particles and cells");
  return [options] {
    if (options->target == "dem") {
      DemBenchOptions dem{.peer = options->peer, .quick = options->quick};
      if (!options->folder.empty()) dem.out = options->folder;
      return bench_dem(dem);
    }
    if (options->target == "coupling") {
      CouplingBenchOptions coupling{.n_steps = options->n_steps, .peer = options->peer, .quick = options->quick};
      if (!options->folder.empty()) coupling.out = options->folder;
      return bench_coupling(coupling);
    }
    if (options->target != "flow")
      throw Error(ExitCode::usage, "snag bench " + options->target + ": there is no such benchmark; there are: flow, dem, coupling");
    if (!options->folder.empty()) options->out = options->folder;
    return bench_flow(*options);
  };
}
const Command bench(50, add_bench);

}  // namespace

}  // namespace snag
