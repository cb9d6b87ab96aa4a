#include "app/bench/dem.hpp"

#include <cstdio>

#include "app/bench/dem_cases.hpp"
#include "app/bench/dem_timing.hpp"

namespace snag {

ExitCode bench_dem(const DemBenchOptions& options) {
  const auto show = [&](const char* name, DemBenchCase made, double work, int repeats) {
    const DemTiming t = timed(made, work, repeats);
    std::printf("%-16s %8.2f M/s user %8.2f wall, %6.2f ns, %5.2f contacts, %6.1f steps a list, dt %.3g\n", name, t.per_core(), t.on_the_clock(),
                1e3 / t.per_core(), t.contacts_per_particle, t.sub_steps_per_list, made.rags->stable_step());
    std::fflush(stdout);
  };
  const std::string only = options.out.filename().string();
  const auto wants = [&](const char* name) { return only == "all" || only == name; };
  const double work = options.quick ? 3e6 : 1e7;
  if (wants("flat")) show("flat", flat_sheets(MPI_COMM_WORLD, 1, 150, 110), work, 4);
  if (wants("stack")) show("stack", stacked_sheets(MPI_COMM_WORLD), work / 3, 4);
  if (wants("moving")) show("moving", stacked_sheets(MPI_COMM_WORLD, 3, 60), work / 3, 4);
  if (wants("small")) show("small", flat_sheets(MPI_COMM_WORLD, 1, 75, 55), work, 4);
  if (wants("large")) show("large", flat_sheets(MPI_COMM_WORLD, 1, 600, 440), work, 4);
  if (wants("hundred")) show("hundred", flat_sheets(MPI_COMM_WORLD, 100, 150, 110), 2e6, 2);
  return ExitCode::ok;
}

}  // namespace snag
