#pragma once
// Is the start of a run possible: every particle in the water, in front of the walls, and clear of the others?
#include "app/simulation.hpp"

namespace snag {

/// Throws Error(usage) that names the piece if a particle's centre is outside the mesh or beyond a wall, or if particles overlap each other
/// or a wall by more than half a radius. Of a simulation before its first step; moves nothing. Collective.
void check_start(const Simulation& simulation);

}  // namespace snag
