#pragma once
// How far the edges of a cloth are from a particle, along its row and along its column of the lattice:
//
//   1/s^2 = (o_1/s_1 + o_2/s_2)^2 + (o_3/s_3 + o_4/s_4)^2
//
// s_i: distance to the edge at each end; o_i: openness of that edge, 2 (1 - kappa) within 0 and 1, kappa: coverage at the last particle
// before it. An edge at a wall, at a plane of symmetry or on other cloth is closed: no water passes beside it. At a straight free edge far
// from the others s is the distance from it. For a potential difference of an ellipse, ((s_1 s_2) (1 - eta^2))^(1/2), as of an accelerated
// strip or disc, -4 times its surface Laplacian over itself is 1/s^2 exactly.
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
