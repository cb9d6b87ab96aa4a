#pragma once
// Is the start of a run possible: every particle in the water, in front of the walls, and clear of the others?
#include "app/simulation.hpp"

namespace snag {

/// Throws Error(usage) that names the piece if a particle's centre is outside the mesh or beyond a wall, or if particles overlap each other
/// or a wall by more than half a radius. Of these rags, which have been put in and not moved yet; moves nothing. Collective.
void check_start(const Simulation& simulation, const std::vector<int>& which);

}  // namespace snag
