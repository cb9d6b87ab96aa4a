#pragma once
#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

/// Of each cell, [n_all_cells], the lowest cell_id of its region: the cells that inner faces join to it, one after the other. Facets of a
/// sliding interface count as inner faces. Collective.
std::vector<std::int64_t> regions(const Mesh& mesh);

}  // namespace snag
