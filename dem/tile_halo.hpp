#pragma once
// The halo of the tiles: whole ghost tiles from other ranks, then the rings of the owned tiles from their lattice neighbours.
#include <mpi.h>

#include <span>
#include <vector>

#include "dem/lattice.hpp"
#include "dem/tile.hpp"

namespace snag {

class TileHalo {
 public:
  /// One rank that tiles are exchanged with: places of owned tiles that it needs, places of ghosts that it owns, both by ascending number.
  struct Neighbour {
    int rank = 0;
    std::vector<int> send, receive;
    std::vector<double> out, in;
  };

  /// `local(number)`: pointer to the tile of that number here, owned or ghost, or null. Ghosts of the neighbours must be sized.
  TileHalo(MPI_Comm comm, std::vector<Neighbour> neighbours, std::span<Tile> owned, std::span<Tile> ghosts);
  /// Lists what the ring of an owned tile is copied from: the tiles left, right, below and above (null at the edge of the piece).
  void add_ring(Tile& tile, const Tile* left, const Tile* right, const Tile* below, const Tile* above);
  /// Brings ghosts up to date. Collective over the neighbours.
  void exchange_ghosts();
  /// Fills the rings of the tiles that were added, from owned and ghost tiles as they are.
  void fill_rings();
  /// Both, for all tiles.
  void exchange();

 private:
  struct Ring {
    Tile* tile;
    const Tile* from[4];  // left, right, below, above
  };
  MPI_Comm comm_;
  std::vector<Neighbour> neighbours_;
  std::span<Tile> owned_, ghosts_;
  std::vector<Ring> rings_;
  std::vector<MPI_Request> requests_;
};

/// State of the particles of a tile (without ring), field by field, row by row: n_state * nx * ny doubles.
double* pack_state(const Tile& tile, double* out);
const double* unpack_state(Tile& tile, const double* in);

}  // namespace snag
