#include "simulation/output/checkpoint_clock.hpp"

#include <mpi.h>

namespace snag {

CheckpointClock::CheckpointClock(const Simulation& simulation)
    : simulation_(simulation), last_time_(simulation.time()), last_wall_(MPI_Wtime()) {}

bool CheckpointClock::is_due() {
  const CheckpointSettings& settings = simulation_.checkpoint_settings;
  const double time = simulation_.time();
  int now = settings.interval && time - last_time_ > *settings.interval * (1 - 1e-9);
  if (MPI_Wtime() - last_wall_ > settings.wall_interval) now = 1;
  MPI_Bcast(&now, 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (now) last_time_ = time, last_wall_ = MPI_Wtime();
  return now != 0;
}

}  // namespace snag
