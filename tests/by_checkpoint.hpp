#pragma once
// What a resumed run begins with.
#include <mpi.h>

#include <filesystem>
#include <string>

#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"

namespace snag::test {

/// Writes a checkpoint to the disk by save(writer) and reads it by load(reader). `name`: of the test. Collective.
template <class Save, class Load>
void by_checkpoint(MPI_Comm comm, const std::string& name, const Save& save, const Load& load) {
  const auto folder = std::filesystem::temp_directory_path() / ("snag_" + name + "_" + std::to_string(size_of(comm)));
  if (rank_of(comm) == 0) std::filesystem::remove_all(folder);
  MPI_Barrier(comm);
  {
    CheckpointWriter writer(comm, folder, {.case_sha256 = "test", .ranks = size_of(comm), .time_step = 1, .time = 0});
    save(writer);
    writer.finish();
  }
  {
    CheckpointReader reader(comm, folder);
    load(reader);
  }
  MPI_Barrier(comm);
  if (rank_of(comm) == 0) std::filesystem::remove_all(folder);
}

}  // namespace snag::test
