#pragma once
// Clocks of snag bench dem.
#include <mpi.h>

#include "benchmark/speed/dem_cases.hpp"

namespace snag {

/// Seconds of all ranks of a communicator.
struct Seconds {
  double user = 0;  // of the processors in the program itself, summed over the ranks
  double wall = 0;  // on the clock
};

/// What some sub-steps of a case took: the least of the repetitions.
struct DemTiming {
  double particle_steps = 0;  // of one repetition, all ranks
  Seconds seconds;
  double contacts_per_particle = 0;  // pairs count for both; walls not
  double sub_steps_per_list = 0;     // between two searches for contacts; 0: there was none

  /// Million particle-steps a second of one processor, or on the clock.
  double per_core() const { return 1e-6 * particle_steps / seconds.user; }
  double on_the_clock() const { return 1e-6 * particle_steps / seconds.wall; }
};

/// Times `n_repeats` times about `particle_steps` of a case, after as many sub-steps to settle. Collective over the system's ranks.
DemTiming timed(DemBenchCase& bench, double particle_steps, int n_repeats);

}  // namespace snag
