#pragma once
// The openings of a mesh: its patches on which pressure is given.
#include <vector>

#include "app/opening.hpp"
#include "mesh/mesh.hpp"
#include "solver/boundary.hpp"

namespace snag {

/// Collective.
std::vector<Opening> openings(const Mesh& mesh, const BoundarySet& boundary);

}  // namespace snag
