#pragma once
// Is the start of a run possible: every particle in the water, in front of the walls, and clear of the others?
#include "simulation/setup/simulation.hpp"

namespace snag {

/// Throws Error(usage) that names the piece if a particle's centre is outside the mesh or beyond a wall, or if particles overlap each other
/// or a wall by more than half a radius. Of these rags, which have been put in and not moved yet; moves nothing. Collective.
/// `crowding`: overlap_of_particles() before they were put in; a run under way may have pressed others together more than that.
void check_start(const Simulation& simulation, const std::vector<int>& which, double crowding);

/// Of a rag that waits: throws Error(usage) if it would never be put in; and if its particles' centres are outside the mesh, or warns of it
/// where a zone turns and may make room. Before the first step; collective.
void check_waiting(const Simulation& simulation, int rag);

/// Largest overlap between particles over the radius, of all rags as they are now. Collective.
double overlap_of_particles(RagSystem& rags);

}  // namespace snag
