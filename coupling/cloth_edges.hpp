#pragma once
// How far the edges of a cloth are from a particle, along its row and along its column of the lattice:
//
//   1/s^2 = (o_1/s_1 + o_2/s_2)^2 + (o_3/s_3 + o_4/s_4)^2
//
// s_i: distance from the edge at each end of the row and of the column. o_i: openness of that edge, 2 (1 - kappa), but at least 0 and at
// most 1; kappa is the coverage at the last particle before the edge. No water passes an edge at a wall, at a plane of
// symmetry or at another cloth: this edge is closed. Near one straight open edge s is the distance from this edge. An accelerated strip,
// disc or ellipse has a potential jump whose surface Laplacian is -1/(4 s^2) times the jump, exactly.
#include <mpi.h>

#include <span>
#include <vector>

#include "coupling/particle_list.hpp"
#include "dem/particles/rag.hpp"

namespace snag {

/// Fills field `edge_distance` of `arrays`, s in m (at most 1e3 m), from their field `coverage`, for all particles of this rank; the same
/// on any ranks. Collective.
void find_edge_distances(MPI_Comm comm, const std::vector<Rag>& rags, std::span<const Tile> tiles, TileArrays& arrays, int coverage,
                         int edge_distance);

}  // namespace snag
