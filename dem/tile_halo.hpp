#pragma once
// The halo of the tiles: rows of ghost tiles from other ranks, then the rings of the owned tiles from their lattice neighbours.
#include <mpi.h>

#include <span>
#include <vector>

#include "dem/particles/tile.hpp"
#include "dem/templates/lattice.hpp"

namespace snag {

/// Rows first .. end of a tile, which is identified by its number, or by its index in a list.
struct TileRows {
  int tile = 0, first = 0, end = 0;
  bool operator==(const TileRows&) const = default;
};

class TileHalo {
 public:
  /// One rank that rows are exchanged with: those of owned tiles (by place) that it needs, those of ghosts that it owns, in the same order
  /// on both sides.
  struct Neighbour {
    int rank = 0;
    std::vector<TileRows> send, receive;
    std::vector<double> out, in;
  };

  /// Allocate the ghosts first: the constructor sizes the messages by them. `with_bonds`: each exchange also sends the marks of whole
  /// bonds.
  TileHalo(MPI_Comm comm, std::vector<Neighbour> neighbours, std::span<Tile> owned, std::span<Tile> ghosts, bool with_bonds);
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
  bool with_bonds_;
  std::vector<Ring> rings_;
  std::vector<MPI_Request> requests_;
};

/// State of the particles in rows first .. end of a tile (without ring), field by field, row by row: n_state * nx doubles a row.
double* pack_state(const Tile& tile, int first, int end, double* out);
const double* unpack_state(Tile& tile, int first, int end, const double* in);

}  // namespace snag
