#pragma once
// A whole mesh on rank 0 as a DMPlex, the form in which PETSc distributes it.
#include <petscdmplex.h>

#include <vector>

#include "mesh/import/connectivity.hpp"
#include "mesh/import/parts.hpp"

namespace snag {

// Labels of the DMPlex: index of the zone of a cell, of the patch of a face.
inline constexpr const char *zone_label = "zone", *patch_label = "patch";

/// Numbers of rank 0's cells in the order that DMPlex wants: tetrahedra, hexahedra, prisms, pyramids, each in their own order.
std::vector<PetscInt> plex_order(const MeshParts& whole);

/// The DMPlex with cells, faces and vertices, without edges, which took most of an import; cell i of it is cell order[i]. Collective; only
/// rank 0's parts and `faces` (fitting_faces) are read. The caller destroys it.
DM plex_of(const MeshParts& whole, const std::vector<LocalFace>& faces, const std::vector<PetscInt>& order, MPI_Comm comm);

}  // namespace snag
