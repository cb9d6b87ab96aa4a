#pragma once
// Bond forces of a whole tile.
#include <array>

#include "dem/bonds/bond_law.hpp"
#include "dem/particles/tile.hpp"

namespace snag {

/// Bonds of a rag: law along the row and between rows.
using BondLaws = std::array<BondLaw, 2>;
BondLaws bond_laws(const Rag& rag);

/// End of a bond at a place of a tile.
template <int direction>
BondEnd bond_end(const Tile& tile, int k) {
  const double w = tile.field(Tile::qw)[k];
  const Vec3 v = tile.vector(Tile::qx, k);
  return {.x = tile.vector(Tile::x, k),
          .v = tile.vector(Tile::vx, k),
          .w = tile.vector(Tile::wx, k),
          .qw = w,
          .qx = v.x,
          .qy = v.y,
          .qz = v.z,
          .a = carried_direction<direction>(w, v.x, v.y, v.z)};
}

/// Sets fx .. tz (N, N m) of the tile's particles to what their bonds give; the ring must be up to date. Bonds across the tile's edge are
/// evaluated too, from the same numbers as the neighbour does. With `breakage` bonds that do not hold get the mark 0 and no force from this
/// call on; returns how many broke of those that the tile owns (end 1 in the tile), else 0. Particles of the ring get arbitrary values.
/// `next` is fetched from memory meanwhile: the tile that is due after this one, or the same.
int set_bond_forces(const BondLaws& laws, bool breakage, Tile& tile, const Tile& next);

}  // namespace snag
