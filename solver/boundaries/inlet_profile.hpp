#pragma once
// Profile of the speed over an inlet, from the distance d of a point to the walls around its patch, D the largest such distance of the
// patch (within 0.1 %):
//
//   laminar:    s (2 - s),  s = d/D          exact for a round pipe and between plates
//   turbulent:  s^(1/7)                      power law of developed pipe flow, Nikuradse (1932), Re about 1e5
//
// A face has the mean over its area, divided by the mean over the patch. Walls are the edges of the patch's rim that it shares with a
// patch of walls: planes of symmetry, periodic sides and other openings slow nothing.
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

enum class Profile { uniform, laminar, turbulent };

/// Speed over mean speed at each face of the patch; uniform: 1. `walls`: the patches that are walls. Collective; throws Error(usage) where
/// no edge of the patch lies at a wall and the profile is not uniform.
std::vector<double> inlet_profile(const Mesh& mesh, const Patch& patch, const std::vector<Patch>& walls, Profile profile);

}  // namespace snag
