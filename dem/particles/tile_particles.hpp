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

}  // namespace snag
