#pragma once
// Profile of the speed over an inlet, from the distance d of a face to the rim of its patch, D the largest such distance:
//
//   laminar:    s (2 - s),  s = d/D          exact for a round pipe and between plates
//   turbulent:  s^(1/7)                      power law of developed pipe flow, Nikuradse (1932), Re about 1e5
//
// divided by its mean over the patch. The whole rim counts as wall.
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

enum class Profile { uniform, laminar, turbulent };

/// Speed over mean speed at each face of the patch; uniform: 1. Collective.
std::vector<double> inlet_profile(const Mesh& mesh, const Patch& patch, Profile profile);

}  // namespace snag
