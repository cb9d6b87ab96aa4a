#pragma once
// How far the edges of a cloth are from a particle, along its row and along its column of the lattice:
//
//   1/s^2 = (o_1/s_1 + o_2/s_2)^2 + (o_3/s_3 + o_4/s_4)^2
//
// s_i: distance from the edge at each end of the row and of the column. o_i: openness of that edge, (1 - kappa)/(1 - kappa_open), but at
// least 0 and at most 1; kappa is the coverage at the last particle before the edge, r_p inside it, kappa_open what it is there at a
// straight open edge, (1 + erf(r_p/(2 delta)))/2, delta the width of kernel and cell. No water passes an edge at a wall, at a plane of
// symmetry or at another cloth: this edge is closed. Near one straight open edge s is the distance from this edge. An accelerated strip,
// disc or ellipse has a potential jump whose surface Laplacian is -1/(4 s^2) times the jump, exactly.
//
// The sides of a cut are edges: closed while they lie side by side, open where they have moved apart. As far as a cut is closed, the edges
// behind it count: o_1/s_1 of an end is then the sum over all edges to that side, nearest first,
//
//   o_a/s_a + (1 - o_a) (o_b/s_b + (1 - o_b) (...))
#include <mpi.h>

#include <span>
#include <vector>

#include "coupling/particle_list.hpp"
#include "dem/particles/rag.hpp"

namespace snag {

class ClothEdges {
 public:
  /// `rags` must outlive this object.
  explicit ClothEdges(const std::vector<Rag>& rags);
  /// Numbers of the fields in the arrays of the particles.
  struct Fields {
    int coverage = 0, width = 0;  // kappa; delta, m
    int edge_distance = 0;        // s, m
  };
  /// Fills s (at most 1e3 m) from the other fields, for all particles of this rank; the same on any ranks. Collective.
  void find_distances(MPI_Comm comm, std::span<const Tile> tiles, TileArrays& arrays, const Fields& fields) const;

 private:
  /// A row or a column, in parts between its cuts.
  struct Line {
    std::size_t first = 0;  // number of its first end: part p has the ends first + 2 p and first + 2 p + 1
    std::vector<int> cuts;  // last places before the cuts, ascending
  };
  const Line& row(const Tile& tile, int number) const { return lines_[tile.rag][number]; }
  const Line& column(const Tile& tile, int number) const { return lines_[tile.rag][rags_[tile.rag].n_rows + number]; }

  const std::vector<Rag>& rags_;
  std::vector<std::vector<Line>> lines_;  // [rag][rows, then columns]
  std::size_t n_ends_ = 0;                // of all lines
};

}  // namespace snag
