#pragma once
// Where the two sides of a sliding interface do not cover each other: for the message of the error and a picture.
#include <mpi.h>

#include <filesystem>
#include <vector>

#include "mesh/sliding/sliding_surface.hpp"

namespace snag {

/// Area that facets cover of each face, m2, in the order of the sides' faces; of this rank's faces only, the others are not read.
struct FacetCover {
  std::vector<double> rotor, stator;
};

/// Throws Error(mesh) if facets with the rotor turned by `turn` leave a face open; the message says where, and names the picture.
/// `picture`: a .vtp that rank 0 writes with the open faces of all ranks (cell arrays: covered share, turning or stationary side, cell);
/// none if empty. The same error on every rank. Collective.
void require_cover(const RevolvedSurface& surface, MPI_Comm comm, Angle turn, const FacetCover& cover,
                   const std::filesystem::path& picture);

}  // namespace snag
