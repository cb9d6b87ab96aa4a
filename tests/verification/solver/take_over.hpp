#pragma once
// What a resumed run begins with.
#include <filesystem>

#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "solver/flow_solver.hpp"

namespace snag::test {

/// Brings a solver to the state of another one by a checkpoint on the disk. `name`: of the test. Collective over the ranks of the mesh.
inline void take_over(const FlowSolver& from, FlowSolver& into, const std::string& name) {
  const MPI_Comm comm = from.flow.mesh.comm;
  const auto folder = std::filesystem::temp_directory_path() / ("snag_" + name + "_" + std::to_string(size_of(comm)));
  {
    CheckpointWriter writer(comm, folder,
                            {.case_sha256 = "test", .ranks = size_of(comm), .time_step = from.flow.time_step, .time = from.flow.time});
    from.save(writer);
    writer.finish();
  }
  {
    CheckpointReader reader(comm, folder);
    into.load(reader);
  }
  MPI_Barrier(comm);
  if (rank_of(comm) == 0) std::filesystem::remove_all(folder);
}

}  // namespace snag::test
