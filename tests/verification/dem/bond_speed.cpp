// The kernel of the tiles against the same law called bond by bond: a compiler or an edit that stops the loops from vectorising is noticed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "dem/bonds/bond_law.hpp"
#include "dem/bonds/tile_rows.hpp"
#include "dem/templates/lattice.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

/// Least processor time of some repetitions, s.
template <class Work>
double least_time(const Work& work) {
  double least = 1e9;
  for (int repetition = 0; repetition < 7; ++repetition) {
    const std::clock_t begun = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC);
  }
  return least;
}

TEST(BondSpeed, TilesAreFasterThanBondByBond) {
  // Requirement: with vectors of at least four numbers the kernel evaluates bonds at least twice as fast as a plain loop over them.
#if !defined(__AVX2__) || !defined(__OPTIMIZE__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "no vectors, no optimisation, or a sanitizer";
#endif
  RagPiece piece = testing_pieces::cloth(30, 14);
  piece.rag.bond_damping = 0.5, piece.rag.rotation_friction = 0.001;
  Tile tile = make_tile(piece, 0, tile_grid(30, 14), 0);
  const auto bonds = bonds_of(piece.rag);
  const double n_bonds = static_cast<double>(count_bonds(piece));
  const int n = 600;
  const double kernel = least_time([&] {
    for (int repetition = 0; repetition < n; ++repetition) bonds->set_forces(false, tile, tile);
  });
  Vec3 sum;
  const double plain = least_time([&] {
    for (int repetition = 0; repetition < n; ++repetition)
      for (int j = 0; j < tile.ny; ++j)
        for (int i = 0; i + 1 < tile.nx; ++i) {
          const int k = tile.index(i, j);
          const BondForce bond = bond_force<0, true>(bonds->coefficients(0), bond_end<0>(tile, k), bond_end<0>(tile, k + 1));
          sum += bond.force + bond.torque1 + bond.torque2;
        }
  });
  const double kernel_rate = n * n_bonds / kernel, plain_rate = n * 29 * 14 / plain;
  std::printf("%.1f million bonds/s, bond by bond %.1f, sum %g\n", kernel_rate / 1e6, plain_rate / 1e6, norm(sum));
  EXPECT_GT(kernel_rate, 2 * plain_rate);
}

}  // namespace
}  // namespace snag
