#include "simulation/output/wall_cells.hpp"

#include <algorithm>

namespace snag {

std::vector<int> cells_at_walls(const FlowSolver& water) {
  const Mesh& mesh = water.flow.mesh;
  std::vector<int> cells;
  for (int p = 0; p < static_cast<int>(mesh.patches.size()); ++p)
    if (water.boundary().is_wall(p))
      for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) cells.push_back(mesh.owner[f]);
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

}  // namespace snag
