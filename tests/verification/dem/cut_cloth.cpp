// ranks: 1 2 3
// Cuts in cloth: it comes apart there and nowhere else, on any number of ranks and after a restart.
#include <gtest/gtest.h>

#include <numbers>

#include "dem/contacts/contact_solver.hpp"
#include "dem/rag_measures.hpp"
#include "dem/walls/walls.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "tests/by_checkpoint.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

using namespace testing_pieces;

/// Clamped at its first column, loaded at its last by a force F across it on each particle of the first `n_loaded` rows, until it rests.
struct Cantilever {
  static constexpr double F = 2e-6, rate = 60;  // N; 1/s
  Cantilever(const RagPiece& piece, int n_loaded) : rags(MPI_COMM_SELF, DemSettings{}, {piece}), rag(rags.rags()[0]) {
    rags.clamp([this](std::int64_t id) { return id % rag.n_columns == 0; });
    rags.set_damping_rate(rate);
    EachParticle load(rags, [&](Tile& tile, int k, std::int64_t id) {
      add_drag(rags, tile, k, rate);
      if (id % rag.n_columns == rag.n_columns - 1 && id / rag.n_columns < n_loaded) tile.field(Tile::fz)[k] += F;
    });
    rags.advance(0.6, &load);
  }
  double tip(int row) { return position(rags, static_cast<std::int64_t>(row + 1) * rag.n_columns - 1).z; }

  RagSystem rags;
  const Rag& rag;
};

TEST(CutCloth, CantileverCutInTwoBendsAsTwoStrips) {
  // Requirement: a cut from end to end makes two strips of a cantilever. The loaded one bends as Euler and Bernoulli say, F L^3/(3 EI) and
  // the shear of its bonds for each of its rows, within 0.5 % (10 spacings). The other one stays where it is; without the cut both bend.
  const int n_columns = 11, n_rows = 6, n_loaded = 3;
  RagPiece whole = cloth(n_columns, n_rows), cut = whole;
  cut.rag.cuts = {{{-0.02, 0}, {0.02, 0}}};
  EXPECT_EQ(count_bonds(cut), count_bonds(whole) - n_columns);
  const double r = whole.rag.radius, L = 2 * r * (n_columns - 1), I = std::numbers::pi / 4 * std::pow(r, 4);
  const BondProperties& bond = whole.rag.bond[0];
  const double bend = Cantilever::F * L * L * L / (3 * bond.bending_stiffness * 2 * r * I);
  const double exact = bend + (n_columns - 1) * Cantilever::F / (bond.tangential_stiffness * std::numbers::pi * r * r);
  Cantilever strips(cut, n_loaded), sheet(whole, n_loaded);
  for (int row = 0; row < n_rows; ++row)
    std::printf("  row %d: cut %.6f, whole %.6f of two beams\n", row, strips.tip(row) / exact, sheet.tip(row) / exact);
  for (int row = 0; row < n_loaded; ++row) EXPECT_NEAR(strips.tip(row), exact, 5e-3 * exact);
  for (int row = n_loaded; row < n_rows; ++row) EXPECT_EQ(strips.tip(row), 0);
  EXPECT_GT(sheet.tip(n_rows - 1), 0.1 * exact);
  EXPECT_LT(sheet.tip(0), 0.9 * exact);
}

/// A sheet of several tiles with a straight and an oblique cut, and a disc cut in sectors, thrown so that sides of the cuts touch.
struct ThrownPieces {
  explicit ThrownPieces(MPI_Comm comm) : rags(comm, {}, pieces()) {
    rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), &none));
    for (Tile& tile : rags.tiles())
      for (int j = 0; j < tile.ny; ++j)
        for (int i = 0; i < tile.nx; ++i) {
          const auto [x, y] = rags.rags()[tile.rag].place(tile.column + i, tile.row + j);
          tile.set_vector(Tile::vx, tile.index(i, j), {-40 * x, -60 * y, 4000 * x * x + 20 * y});
        }
  }
  static std::vector<RagPiece> pieces() {
    RagPiece sheet = cloth(70, 40), disc = cloth(36, 36);
    sheet.rag.bond_damping = disc.rag.bond_damping = 0.5;
    sheet.rag.cuts = {{{-0.08, 0}, {0.01, 0}}, {{-0.01, -0.05}, {0.05, 0.03}}};
    disc.rag.mask_radius = 0.036, disc.centre = {0, 0, 0.05};
    for (int c = 0; c < 9; ++c) {
      const double angle = 0.1 + c * 2 * std::numbers::pi / 9, x = std::cos(angle), y = std::sin(angle);
      disc.rag.cuts.push_back({{0.01 * x, 0.01 * y}, {0.04 * x, 0.04 * y}});
    }
    return {sheet, disc};
  }
  void advance(int n_steps) {
    const int size = size_of(rags.comm());
    for (int k = 0; k < n_steps / 50; ++k) {
      rags.migrate([&](const std::vector<Vec3>& centres) {
        std::vector<int> ranks;
        for (std::size_t t = 0; t < centres.size(); ++t) ranks.push_back(static_cast<int>(centres[t].y / 0.012 + 1000 * size + k) % size);
        return ranks;
      });
      rags.advance(50 * 8e-6);
    }
  }
  WallSet none;
  RagSystem rags;
};

double largest_difference(const RagSheet& a, const RagSheet& b) {
  double largest = a.id == b.id && a.triangles == b.triangles ? 0 : infinity;
  for (std::size_t k = 0; k < a.id.size(); ++k)
    largest = std::max(largest, norm(a.position[k] - b.position[k]) + norm(a.velocity[k] - b.velocity[k]));
  return largest;
}

TEST(CutCloth, TheSameOnAnyNumberOfRanks) {
  // Requirement: cut pieces move alike on any number of ranks, to the bit, cuts across tiles too, and no bond is lost or counted as broken.
  ThrownPieces alone(MPI_COMM_SELF), spread(MPI_COMM_WORLD);
  alone.advance(500), spread.advance(500);
  const std::vector<BondCount> bonds = spread.rags.check();
  for (std::size_t r = 0; r < bonds.size(); ++r) {
    RagPiece uncut = alone.rags.pieces()[r];
    uncut.rag.cuts.clear();
    EXPECT_EQ(bonds[r].broken, 0);
    EXPECT_LT(bonds[r].whole, count_bonds(uncut));
  }
  const RagSheet a = gather_sheet(alone.rags), b = gather_sheet(spread.rags);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_EQ(largest_difference(a, b), 0);
  }
  EXPECT_GT(sum(MPI_COMM_WORLD, spread.rags.contacts()->measures().n_contacts), 5) << "no sides touch: the test says little";
}

TEST(CutCloth, ResumedRunEqualsTheUninterruptedOneToTheBit) {
  // Requirement: cuts are cuts after a restart.
  ThrownPieces whole(MPI_COMM_WORLD), second(MPI_COMM_WORLD);
  whole.advance(150);
  test::by_checkpoint(
      MPI_COMM_WORLD, "cut_cloth", [&](CheckpointWriter& writer) { whole.rags.save(writer); },
      [&](CheckpointReader& reader) { second.rags.load(reader); });
  whole.advance(150), second.advance(150);
  EXPECT_EQ(largest_difference(gather_sheet(whole.rags), gather_sheet(second.rags)), 0);
}

}  // namespace
}  // namespace snag
