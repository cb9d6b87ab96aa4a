#include "simulation/output/checkpoints.hpp"

#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"

namespace snag {

Checkpoints::Checkpoints(std::filesystem::path folder, const CaseFile& file, const Simulation& simulation)
    : folder_(std::move(folder)), file_(file), simulation_(simulation), last_time_(simulation.time()), last_wall_(MPI_Wtime()) {}

bool Checkpoints::due() {
  const CheckpointSettings& settings = simulation_.checkpoint_settings;
  const double time = simulation_.time();
  int now = settings.interval && time - last_time_ > *settings.interval * (1 - 1e-9);
  if (MPI_Wtime() - last_wall_ > settings.wall_interval) now = 1;
  MPI_Bcast(&now, 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (now) last_time_ = time, last_wall_ = MPI_Wtime();
  return now != 0;
}

void Checkpoints::write(const std::function<void(CheckpointWriter&)>& save_more) const {
  CheckpointWriter writer(MPI_COMM_WORLD, folder_ / "checkpoint",
                          {.case_sha256 = file_.resume_sha256(),
                           .ranks = size_of(MPI_COMM_WORLD),
                           .time_step = simulation_.time_step(),
                           .time = simulation_.time()});
  simulation_.save(writer);
  save_more(writer);
  writer.finish();
}

}  // namespace snag
