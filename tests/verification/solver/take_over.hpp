#pragma once
#include "solver/flow_solver.hpp"
#include "tests/by_checkpoint.hpp"

namespace snag::test {

/// Brings a solver to the state of another one by a checkpoint on the disk. `name`: of the test. Collective over the ranks of the mesh.
inline void take_over(const FlowSolver& from, FlowSolver& into, const std::string& name) {
  by_checkpoint(
      from.flow.mesh.comm, name, [&](CheckpointWriter& writer) { from.save(writer); },
      [&](CheckpointReader& reader) { into.load(reader); });
}

}  // namespace snag::test
