#pragma once
#include <vector>

#include "solver/flow_solver.hpp"

namespace snag {

/// Cells with a face on a wall, in ascending order, each once. Local.
std::vector<int> cells_at_walls(const FlowSolver& water);

}  // namespace snag
