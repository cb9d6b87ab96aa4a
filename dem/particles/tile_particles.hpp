#pragma once
// Visiting the particles of a tile, where a loop need not vectorise.
#include "dem/particles/tile.hpp"

namespace snag {

/// f(place, column, row) for every particle of a tile that exists, row by row; the ring is left out.
template <class F>
void for_particles(const Tile& tile, const F& f) {
  for (int j = 0; j < tile.ny; ++j)
    for (int i = 0; i < tile.nx; ++i)
      if (tile.exists[tile.index(i, j)] > 0.5) f(tile.index(i, j), i, j);
}

/// f(first place, second place) for the whole bonds whose first end is in the tile, or with `from_ring` also those from the ring; row by
/// row, of a place the bond along the row first.
template <class F>
void for_whole_bonds(const Tile& tile, bool from_ring, const F& f) {
  for (int j = from_ring ? -1 : 0; j < tile.ny; ++j)
    for (int i = from_ring ? -1 : 0; i < tile.nx; ++i) {
      const int k = tile.index(i, j);
      if (j >= 0 && tile.bond_x[k] > 0.5) f(k, k + 1);
      if (i >= 0 && tile.bond_y[k] > 0.5) f(k, k + tile.stride);
    }
}

}  // namespace snag
