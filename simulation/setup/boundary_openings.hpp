#pragma once
// The openings of a mesh: its patches on which pressure is given, or by which water leaves.
#include <vector>

#include "mesh/mesh.hpp"
#include "observe/passage/opening.hpp"
#include "solver/boundaries/boundary.hpp"

namespace snag {

/// Collective.
std::vector<Opening> openings(const Mesh& mesh, const BoundarySet& boundary);

}  // namespace snag
