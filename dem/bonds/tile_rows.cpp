#if defined(__AVX512F__) && !defined(__clang__)
#pragma GCC target("prefer-vector-width=512")  // the compiler's choice of half the width costs a fifth of the speed
#endif
#include "dem/bonds/tile_rows.hpp"

#include <algorithm>

namespace snag::tile_rows {

void load(const Tile& tile, int j, Row& row) {
  const int n = tile.stride / 8 * 8, first = (j + 1) * tile.stride;
  for (int f = 0; f < Tile::n_state; ++f) {
    const double* from = tile.field(f) + first;
    double* to = row.value[f] + margin;
#pragma omp simd
    for (int k = 0; k < n; ++k) to[k] = from[k];
  }
  const auto& q = row.value;
#pragma omp simd
  for (int k = margin; k < margin + n; ++k) {
    const double w = q[Tile::qw][k], x = q[Tile::qx][k], y = q[Tile::qy][k], z = q[Tile::qz][k];
    const Vec3 a = carried_direction<0>(w, x, y, z), c = carried_direction<1>(w, x, y, z);
    row.direction[0][0][k] = a.x, row.direction[0][1][k] = a.y, row.direction[0][2][k] = a.z;
    row.direction[1][0][k] = c.x, row.direction[1][1][k] = c.y, row.direction[1][2][k] = c.z;
  }
}

void gather(const RowForces& along, const RowForces& above, const RowForces& below, int j, Tile& tile) {
  const int n = tile.stride / 8 * 8, first = (j + 1) * tile.stride;
  for (int c = 0; c < 3; ++c) {
    double* force = tile.field(Tile::fx + c) + first;
    double* torque = tile.field(Tile::tx + c) + first;
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      const int k = margin + i;
      force[i] = along.force[c][k - 1] - along.force[c][k] + below.force[c][k] - above.force[c][k];
      torque[i] = along.torque1[c][k] + along.torque2[c][k - 1] + above.torque1[c][k] + below.torque2[c][k];
    }
  }
}

double n_whole(const Tile& tile) {
  double n = 0;
  for (int j = 0; j < tile.ny; ++j) {
    const double *x = &tile.bond_x[tile.index(0, j)], *y = &tile.bond_y[tile.index(0, j)];
#pragma omp simd reduction(+ : n)
    for (int i = 0; i < tile.nx; ++i) n += x[i] + y[i];
  }
  return n;
}

double n_whole_from_ring(const Tile& tile) {
  double n = 0;
  for (int j = 0; j < tile.ny; ++j) n += tile.bond_x[tile.index(-1, j)];
  for (int i = 0; i < tile.nx; ++i) n += tile.bond_y[tile.index(i, -1)];
  return n;
}

Workspace& workspace() {
  thread_local Workspace w;
  return w;
}

bool is_chain(const Tile& tile) {
  return tile.ny == 1 && std::all_of(tile.bond_y.begin(), tile.bond_y.end(), [](double whole) { return whole == 0; });
}

}  // namespace snag::tile_rows
