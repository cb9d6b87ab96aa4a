#pragma once
// Rows of a tile for the bonds: the state of two rows is copied into small arrays at fixed places (they stay in the first-level cache, and
// every address is a constant offset), and each particle gathers its four bonds in the order: along the row (as end 1, as end 2), between
// rows (as end 1, as end 2).
#include "dem/bonds/elastic_bond.hpp"
#include "dem/particles/tile.hpp"

namespace snag {

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

namespace tile_rows {

inline constexpr int margin = 8;                          // so that k - 1 and k + 1 of the first and last place can be read
inline constexpr int row_size = margin + max_stride + 8;  // doubles

/// State of one row of particles.
struct Row {
  alignas(64) double value[Tile::n_state][row_size] = {};
  alignas(64) double direction[2][3][row_size] = {};  // carried lattice directions
};

/// Results of the bonds of one row: force on end 2, torques on both ends.
struct RowForces {
  alignas(64) double force[3][row_size] = {}, torque1[3][row_size] = {}, torque2[3][row_size] = {};
};

[[gnu::always_inline]] inline void put(double (&to)[3][row_size], int k, const Vec3& v) { to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z; }

template <int direction>
[[gnu::always_inline]] inline BondEnd end_at(const Row& row, int k) {
  const auto& v = row.value;
  const auto& a = row.direction[direction];
  return {.x = {v[Tile::x][k], v[Tile::y][k], v[Tile::z][k]},
          .v = {v[Tile::vx][k], v[Tile::vy][k], v[Tile::vz][k]},
          .w = {v[Tile::wx][k], v[Tile::wy][k], v[Tile::wz][k]},
          .qw = v[Tile::qw][k],
          .qx = v[Tile::qx][k],
          .qy = v[Tile::qy][k],
          .qz = v[Tile::qz][k],
          .a = {a[0][k], a[1][k], a[2][k]}};
}

/// Copies row j of a tile, -1 and ny are the ring.
void load(const Tile& tile, int j, Row& row);

/// Sets the forces of row j from its bonds along the row, to the row above and from the row below.
void gather(const RowForces& along, const RowForces& above, const RowForces& below, int j, Tile& tile);

/// Rows that are in use. Kept between calls: to clear 90 kB would cost a short chain more than its bonds. What an earlier tile left beyond
/// the places of this one is read, and dropped by selection; the place before the first one is never written.
struct Workspace {
  Row rows[2];
  RowForces along, between[2];
};

Workspace& workspace();

/// Whether the tile has bonds along its one row only: most of a fibre's work is not to look for others.
bool is_chain(const Tile& tile);

/// Whole bonds that the tile owns.
double n_whole(const Tile& tile);
/// Whole bonds of the tile that its neighbours own: those from the ring.
double n_whole_from_ring(const Tile& tile);

}  // namespace tile_rows

}  // namespace snag
