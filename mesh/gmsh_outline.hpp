#pragma once
// The outline of a gmsh file: names of its groups and the order of its volume cells. DMPlex reads the rest but keeps neither.
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

struct GmshOutline {
  std::map<int, std::string> surfaces, volumes;  // physical tag -> name
  std::vector<std::pair<CellShape, int>> cells;  // volume cells in the order of the file: runs of one shape
  std::int64_t n_cells() const {
    std::int64_t total = 0;
    for (const auto& [shape, count] : cells) total += count;
    return total;
  }
};

/// MSH 2.2 and 4.1, ASCII and binary. One rank calls it. Throws Error(io) if the file is missing, cut off or damaged, Error(mesh) for other
/// versions, curved elements, or no volume cells.
GmshOutline gmsh_outline(const std::filesystem::path& file);

}  // namespace snag
