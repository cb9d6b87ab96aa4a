#pragma once
// Bond forces of a whole tile.
#include <array>

#include "dem/bonds/bond_law.hpp"
#include "dem/tile.hpp"

namespace snag {

/// Bonds of a rag: law along the row and between rows.
using BondLaws = std::array<BondLaw, 2>;
BondLaws bond_laws(const Rag& rag);

/// Sets fx .. tz (N, N m) of the tile's particles to what their bonds give; the ring must be up to date. Bonds across the tile's edge are
/// evaluated too, from the same numbers as the neighbour does. With `breakage` bonds that do not hold get the mark 0 and no force from this
/// call on; returns how many broke of those that the tile owns (end 1 in the tile), else 0. Particles of the ring get arbitrary values.
int set_bond_forces(const BondLaws& laws, bool breakage, Tile& tile);

}  // namespace snag
