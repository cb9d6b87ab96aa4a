#pragma once
// How readily the flow through a patch follows the pressure on it:   rho dQ/dt = - G p + ...
//
//   div grad phi = 0,   phi = 1 on the patch, 0 where others have a given pressure, dphi/dn = 0 elsewhere;    G = integral of dphi/dn
//
// A pipe of length L and section A between them has G = A/L. Without corrections for faces that are not orthogonal to the line of centres:
// right to some per cent there, which is enough to control a flow.
#include "solver/boundaries/boundary.hpp"

namespace snag {

/// Outlets with a target of their flow: closed, where the flow is held in the long run, or open, where their level is that of the step
/// before.
enum class ControlledOutlets { closed, open };

/// G, m; `conditions` in the order of the patches. Collective.
double column_conductance(const Mesh& mesh, const std::vector<PatchBoundary>& conditions, const Patch& patch, ControlledOutlets controlled);

}  // namespace snag
