#include "benchmark/speed/dem_timing.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "dem/contacts/contact_solver.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

constexpr int fewest_sub_steps = 20;

double user_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

}  // namespace

DemTiming timed(DemBenchCase& bench, double particle_steps, int n_repeats) {
  RagSystem& rags = *bench.rags;
  const MPI_Comm comm = rags.comm();
  const double n_particles = static_cast<double>(rags.n_particles());
  const int n = std::max(fewest_sub_steps, static_cast<int>(std::ceil(particle_steps / n_particles)));
  DemTiming best;
  best.particle_steps = n * n_particles;
  best.seconds = {infinity, infinity};
  std::int64_t n_lists = 0;
  for (int repeat = -1; repeat < n_repeats; ++repeat) {
    MPI_Barrier(comm);
    const double begun = MPI_Wtime(), used = user_seconds();
    rags.advance(n * rags.stable_step());
    const double user = sum(comm, user_seconds() - used), wall = maximum(comm, MPI_Wtime() - begun);
    if (repeat < 0) {
      n_lists = rags.contacts()->measures().n_lists;
      continue;
    }
    best.seconds = {std::min(best.seconds.user, user), std::min(best.seconds.wall, wall)};
  }
  const ContactMeasures& found = rags.contacts()->measures();
  best.contacts_per_particle = 2 * static_cast<double>(sum(comm, found.n_contacts)) / n_particles;
  if (found.n_lists > n_lists) best.sub_steps_per_list = double(n) * n_repeats / static_cast<double>(found.n_lists - n_lists);
  return best;
}

}  // namespace snag
