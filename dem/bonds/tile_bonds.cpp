// The bond law over a tile, row by row: the state of two rows is copied into small arrays at fixed places (they stay in the first-level
// cache, and every address is a constant offset), bonds of a row are evaluated in vector loops, and each particle gathers its four bonds in
// the order: along the row (as end 1, as end 2), between rows (as end 1, as end 2).
//
// Loops run over whole rows, a multiple of 8 places: a bond has the same bits in every tile that evaluates it, since no remainder loop
// rounds differently. Places without a bond are computed and dropped by selection, so that what stands there is of no matter.
#if defined(__AVX512F__) && !defined(__clang__)
#pragma GCC target("prefer-vector-width=512")  // the compiler's choice of half the width costs a fifth of the speed
#endif
#include "dem/bonds/tile_bonds.hpp"

#include <algorithm>
#include <utility>

namespace snag {

namespace {

constexpr int margin = 8;                          // so that k - 1 and k + 1 of the first and last place can be read
constexpr int row_size = margin + max_stride + 8;  // doubles

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

/// What the next tile to be swept needs from memory, a row at a time, while this one computes: hardware guesses it too late, for each of so
/// many streams ends at every page. The rows of the ring are left to it.
struct Ahead {
  static constexpr int n_lists = Tile::n_fields + 4, line = 8;  // doubles
  const double* row[n_lists];
  int end;  // of the row

  Ahead(const Tile& tile, int j) : end(j < tile.ny ? tile.stride : 0) {
    const std::size_t first = static_cast<std::size_t>(std::min(j, tile.ny) + 1) * tile.stride;
    for (int f = 0; f < Tile::n_fields; ++f) row[f] = tile.field(f) + first;
    const AlignedDoubles* marks[] = {&tile.bond_x, &tile.bond_y, &tile.free, &tile.exists};
    for (int m = 0; m < 4; ++m) row[Tile::n_fields + m] = marks[m]->data() + first;
  }
  /// Places i .. i + 7 of the lists of even number (0) or odd number (1).
  template <int half>
  [[gnu::always_inline]] void fetch(int i) const {
    if (i >= end) return;
#pragma GCC unroll 16
    for (int f = half; f < n_lists; f += 2) __builtin_prefetch(row[f] + i, 0, 2);
  }
};

/// Bonds k of one row: from particle k of `one` to k + 1 of the same row (direction 0) or k of the next row `two` (direction 1).
template <int direction, bool damped, bool breakage>
void evaluate(const BondLaw& given_law, const Row& one, const Row& two, double* whole, int stride, RowForces& out, const Ahead& ahead) {
  const BondLaw law = given_law;
  constexpr int shift = direction == 0 ? 1 : 0;
  const int n = stride / 8 * 8;
  for (int line = 0; line < n; line += Ahead::line) {
    ahead.fetch<direction>(line);
#pragma omp simd
    for (int i = line; i < line + Ahead::line; ++i) {
      const int k = margin + i;
      const BondForce bond = bond_force<direction, damped>(law, end_at<direction>(one, k), end_at<direction>(two, k + shift));
      if constexpr (breakage) whole[i] = ((whole[i] > 0.5) & bond_holds(law, bond)) ? 1.0 : 0.0;
      put(out.force, k, bond.force), put(out.torque1, k, bond.torque1), put(out.torque2, k, bond.torque2);
    }
    // In a loop of its own: GCC would move all of the law behind the selection, and then not vectorise it.
#pragma omp simd
    for (int i = line; i < line + Ahead::line; ++i) {
      const bool present = whole[i] > 0.5;
      for (int c = 0; c < 3; ++c) {
        out.force[c][margin + i] = present ? out.force[c][margin + i] : 0.0;
        out.torque1[c][margin + i] = present ? out.torque1[c][margin + i] : 0.0;
        out.torque2[c][margin + i] = present ? out.torque2[c][margin + i] : 0.0;
      }
    }
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

/// Whole bonds that the tile owns.
double n_whole(const Tile& tile) {
  double n = 0;
  for (int j = 0; j < tile.ny; ++j) {
    const double *x = &tile.bond_x[tile.index(0, j)], *y = &tile.bond_y[tile.index(0, j)];
#pragma omp simd reduction(+ : n)
    for (int i = 0; i < tile.nx; ++i) n += x[i] + y[i];
  }
  return n;
}

/// Whole bonds of the tile that its neighbours own: those from the ring.
double n_whole_from_ring(const Tile& tile) {
  double n = 0;
  for (int j = 0; j < tile.ny; ++j) n += tile.bond_x[tile.index(-1, j)];
  for (int i = 0; i < tile.nx; ++i) n += tile.bond_y[tile.index(i, -1)];
  return n;
}

/// Rows that are in use. Kept between calls: to clear 90 kB would cost a short chain more than its bonds. What an earlier tile left beyond
/// the places of this one is read, and dropped by selection; the place before the first one is never written.
struct Workspace {
  Row rows[2];
  RowForces along, between[2];
};

Workspace& workspace() {
  thread_local Workspace w;
  return w;
}

/// Whether the tile has bonds along its one row only: most of a fibre's work is not to look for others.
bool is_chain(const Tile& tile) {
  return tile.ny == 1 && std::all_of(tile.bond_y.begin(), tile.bond_y.end(), [](double whole) { return whole == 0; });
}

template <bool damped, bool breakage>
void sweep_chain(const BondLaws& laws, Tile& tile, const Tile& next_tile) {
  static const RowForces none;
  Workspace& w = workspace();
  load(tile, 0, w.rows[0]);
  const Ahead ahead(next_tile, 0);
  for (int i = 0; i < tile.stride; i += Ahead::line) ahead.fetch<1>(i);
  evaluate<0, damped, breakage>(laws[0], w.rows[0], w.rows[0], &tile.bond_x[tile.stride], tile.stride, w.along, ahead);
  gather(w.along, none, none, 0, tile);
}

template <bool damped, bool breakage>
void sweep(const BondLaws& laws, Tile& tile, const Tile& next_tile) {
  if (is_chain(tile)) return sweep_chain<damped, breakage>(laws, tile, next_tile);
  Workspace& w = workspace();
  RowForces& along = w.along;
  Row *row = &w.rows[0], *next = &w.rows[1];
  RowForces *below = &w.between[0], *above = &w.between[1];
  load(tile, -1, *row);
  load(tile, 0, *next);
  evaluate<1, damped, breakage>(laws[1], *row, *next, &tile.bond_y[0], tile.stride, *below, {next_tile, next_tile.ny});
  for (int j = 0; j < tile.ny; ++j) {
    std::swap(row, next);
    load(tile, j + 1, *next);
    const Ahead ahead(next_tile, j);
    evaluate<0, damped, breakage>(laws[0], *row, *row, &tile.bond_x[(j + 1) * tile.stride], tile.stride, along, ahead);
    evaluate<1, damped, breakage>(laws[1], *row, *next, &tile.bond_y[(j + 1) * tile.stride], tile.stride, *above, ahead);
    gather(along, *above, *below, j, tile);
    std::swap(above, below);
  }
}

}  // namespace

BondLaws bond_laws(const Rag& rag) { return {bond_law(rag, 0), bond_law(rag, 1)}; }

int set_bond_forces(const BondLaws& laws, bool breakage, Tile& tile, const Tile& next) {
  const bool damped = laws[0].damped() || laws[1].damped();
  if (!breakage) {
    damped ? sweep<true, false>(laws, tile, next) : sweep<false, false>(laws, tile, next);
    return 0;
  }
  const double before = n_whole(tile), from_ring = n_whole_from_ring(tile);
  damped ? sweep<true, true>(laws, tile, next) : sweep<false, true>(laws, tile, next);
  const int broken = static_cast<int>(before - n_whole(tile));
  tile.n_breaks += broken + static_cast<int>(from_ring - n_whole_from_ring(tile));
  return broken;
}

}  // namespace snag
