#pragma once
// A bond law over a tile, row by row (dem/bonds/tile_rows.hpp). `Bond` is the law of the bonds of one lattice direction:
//
//   struct Bond {
//     BondCoefficients coefficients;                                    // damping, strengths; the largest stiffnesses
//     template <int direction, bool damped>                             // inlined, without branches, so that the loops vectorise
//     BondForce force(const BondEnd& one, const BondEnd& two) const;    // most laws: bond_force of dem/bonds/elastic_bond.hpp
//   };
//
// A file that has a Bond of its own includes this header first, for the width of its vectors.
//
// Loops run over whole rows, a multiple of 8 places: a bond has the same bits in every tile that evaluates it, since no remainder loop
// rounds differently. Places without a bond are computed and dropped by selection, so that what stands there is of no matter.
#if defined(__AVX512F__) && !defined(__clang__)
#pragma GCC target("prefer-vector-width=512")  // the compiler's choice of half the width costs a fifth of the speed
#endif
#include <algorithm>
#include <array>
#include <utility>

#include "dem/bonds/bond_law.hpp"
#include "dem/bonds/tile_rows.hpp"
#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace tile_rows {

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
template <int direction, bool damped, bool breakage, class Bond>
void evaluate(const Bond& given_bond, const Row& one, const Row& two, double* whole, int stride, RowForces& out, const Ahead& ahead) {
  const Bond law = given_bond;
  constexpr int shift = direction == 0 ? 1 : 0;
  const int n = stride / 8 * 8;
  for (int line = 0; line < n; line += Ahead::line) {
    ahead.fetch<direction>(line);
#pragma omp simd
    for (int i = line; i < line + Ahead::line; ++i) {
      const int k = margin + i;
      const BondForce bond = law.template force<direction, damped>(end_at<direction>(one, k), end_at<direction>(two, k + shift));
      if constexpr (breakage) whole[i] = ((whole[i] > 0.5) & bond_holds(law.coefficients, bond)) ? 1.0 : 0.0;
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

template <bool damped, bool breakage, class Bond>
void sweep_chain(const std::array<Bond, 2>& laws, Tile& tile, const Tile& next_tile) {
  static const RowForces none;
  Workspace& w = workspace();
  load(tile, 0, w.rows[0]);
  const Ahead ahead(next_tile, 0);
  for (int i = 0; i < tile.stride; i += Ahead::line) ahead.fetch<1>(i);
  evaluate<0, damped, breakage>(laws[0], w.rows[0], w.rows[0], &tile.bond_x[tile.stride], tile.stride, w.along, ahead);
  gather(w.along, none, none, 0, tile);
}

template <bool damped, bool breakage, class Bond>
void sweep(const std::array<Bond, 2>& laws, Tile& tile, const Tile& next_tile) {
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

}  // namespace tile_rows

/// Bonds of a piece by the law `Bond`: along the row and between rows.
template <class Bond>
class TileBonds final : public PieceBonds {
 public:
  explicit TileBonds(const std::array<Bond, 2>& bonds) : bonds_(bonds) {}

  int set_forces(bool breakage, Tile& tile, const Tile& next) const override {
    using namespace tile_rows;
    const bool damped = bonds_[0].coefficients.damped() || bonds_[1].coefficients.damped();
    if (!breakage) {
      damped ? sweep<true, false>(bonds_, tile, next) : sweep<false, false>(bonds_, tile, next);
      return 0;
    }
    const double before = n_whole(tile), from_ring = n_whole_from_ring(tile);
    damped ? sweep<true, true>(bonds_, tile, next) : sweep<false, true>(bonds_, tile, next);
    const int broken = static_cast<int>(before - n_whole(tile));
    tile.n_breaks += broken + static_cast<int>(from_ring - n_whole_from_ring(tile));
    return broken;
  }

  std::vector<MeasuredBond> measured(const Tile& tile, bool from_ring) const override {
    std::vector<MeasuredBond> bonds;
    for_whole_bonds(tile, from_ring, [&](int a, int b) {
      const BondForce bond = b == a + 1 ? bonds_[0].template force<0, false>(bond_end<0>(tile, a), bond_end<0>(tile, b))
                                        : bonds_[1].template force<1, false>(bond_end<1>(tile, a), bond_end<1>(tile, b));
      bonds.push_back(
          {a, b, bond.tension, bond.length, bond.energy_parts[0] + bond.energy_parts[1] + bond.energy_parts[2] + bond.energy_parts[3]});
    });
    return bonds;
  }

  const BondCoefficients& coefficients(int direction) const override { return bonds_[direction].coefficients; }

 private:
  std::array<Bond, 2> bonds_;
};

}  // namespace snag
