#pragma once
// Pieces that are released at a patch of the mesh.
#include <vector>

#include "dem/templates/lattice.hpp"
#include "mesh/mesh.hpp"

namespace snag {

/// Puts the centre of each piece with a release plan at its place below the patch; what its `centre` held counts from there. `mesh` may be
/// null. Collective; throws Error(usage) without a mesh, Error(mesh) for an unknown patch.
void place_at_patches(const Mesh* mesh, std::vector<RagPiece>& pieces);

}  // namespace snag
