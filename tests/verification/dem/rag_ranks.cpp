// ranks: 1 2 3
// long ranks: 5
// The same motion on any number of ranks, and after a restart.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "base/error.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/rag_measures.hpp"
#include "dem/walls/walls.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "tests/by_checkpoint.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

using namespace testing_pieces;

/// A sheet of several tiles that is thrown so that it folds over onto itself, and a disc beside it, above a floor.
std::vector<RagPiece> pieces() {
  RagPiece sheet = cloth(70, 40), disc = cloth(36, 36);
  sheet.rag.bond_damping = 0.5, sheet.rag.rotation_friction = 0.001;
  sheet.centre = {0, 0, 0.004};
  disc.rag.name = "disc", disc.rag.mask_radius = 0.036;
  disc.rag.bond_damping = 0.5;
  disc.centre = {0.03, 0.02, 0.010}, disc.velocity = {-2, 0.3, -2}, disc.spin = {0, 20, 0};
  return {sheet, disc};
}

struct ThrownCloth {
  explicit ThrownCloth(MPI_Comm comm, bool breakage = false) : rags(comm, {}, with_breakage(breakage)) {
    floor.add_plane("floor", {0, 0, 0}, {0, 0, 1});
    rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), &floor));
    rags.set_gravity({0, 0, -9.81});
    for (Tile& tile : rags.tiles()) {
      if (tile.rag != 0) continue;
      for (int j = 0; j < tile.ny; ++j)
        for (int i = 0; i < tile.nx; ++i) {
          const double s = (tile.column + i) / 69.0;
          tile.set_vector(Tile::vx, tile.index(i, j), {-6 * s * s, 0.5 * s, 6 * s});
        }
    }
  }
  static std::vector<RagPiece> with_breakage(bool breakage) {
    std::vector<RagPiece> all = pieces();
    for (RagPiece& piece : all) {
      piece.rag.breakage = breakage;
      for (BondProperties& bond : piece.rag.bond) bond.normal_strength *= 0.02;
    }
    return all;
  }
  /// Slabs of 12 mm along x, dealt out in turn to the ranks: tiles change hands as they move.
  void migrate() {
    const int size = size_of(rags.comm());
    rags.migrate([size](const std::vector<Vec3>& centres) {
      std::vector<int> ranks;
      for (const Vec3& c : centres) ranks.push_back((static_cast<int>(std::floor(c.x / 0.012)) + 1000 * size) % size);
      return ranks;
    });
  }
  void advance(int n_steps) {
    const double step = 8e-6;
    for (int k = 0; k < n_steps / 50; ++k) {
      migrate();
      rags.advance(50 * step);
    }
  }

  WallSet floor;
  RagSystem rags;
};

double largest_difference(const RagSheet& a, const RagSheet& b) {
  double largest = a.id == b.id ? 0 : infinity;
  for (std::size_t k = 0; k < a.id.size(); ++k) {
    largest = std::max(largest, norm(a.position[k] - b.position[k]) / 0.1);
    largest = std::max(largest, norm(a.velocity[k] - b.velocity[k]) / 10);
    for (int c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a.orientation[k][c] - b.orientation[k][c]));
  }
  return largest;
}

TEST(RagRanks, ThousandStepsAreTheSameOnAnyNumberOfRanks) {
  // Requirement: positions, velocities, orientations after 1000 sub-steps with contacts, a wall and migration agree with one rank to 1e-12.
  ThrownCloth alone(MPI_COMM_SELF), spread(MPI_COMM_WORLD);
  alone.advance(1300), spread.advance(1300);
  EXPECT_GE(spread.rags.n_sub_steps(), 1000);
  EXPECT_EQ(alone.rags.n_sub_steps(), spread.rags.n_sub_steps());
  const RagSheet a = gather_sheet(alone.rags), b = gather_sheet(spread.rags);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_LT(largest_difference(a, b), 1e-12);
    EXPECT_EQ(a.triangles, b.triangles);
    std::printf("largest difference %.3g\n", largest_difference(a, b));
  }
  EXPECT_EQ(bond_strain_quantile(alone.rags, 0, 0.99), bond_strain_quantile(spread.rags, 0, 0.99));
  const RagState s = rag_states(alone.rags)[0], t = rag_states(spread.rags)[0];
  EXPECT_NEAR(s.elongation_ratio, t.elongation_ratio, 1e-11 * s.elongation_ratio);
  EXPECT_NEAR(s.bond_energy, t.bond_energy, 1e-11 * s.bond_energy);
  // The cloth does touch itself and the floor, or the test would say little.
  EXPECT_GT(sum(MPI_COMM_WORLD, spread.rags.contacts()->measures().n_contacts), 5);
}

TEST(RagRanks, LongAdvanceIsTheSameOnAnyNumberOfRanks) {
  // Requirement: the same in one call of advance, in which particles move by centimetres (10 ms at 2 to 6 m/s), many times the skin of half
  // a radius, 0.5 mm, that the ghosts were chosen for, so that bounds of the motion must tell when to look at all their places again.
  ThrownCloth alone(MPI_COMM_SELF), spread(MPI_COMM_WORLD);
  spread.migrate();
  alone.rags.advance(1300 * 8e-6), spread.rags.advance(1300 * 8e-6);
  const RagSheet a = gather_sheet(alone.rags), b = gather_sheet(spread.rags);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_LT(largest_difference(a, b), 1e-12);
  }
  EXPECT_GT(sum(MPI_COMM_WORLD, spread.rags.contacts()->measures().n_contacts), 5);
}

TEST(RagRanks, SpheresThatMeetDiagonally) {
  // Requirement: spheres of two ranks that approach each other along a diagonal of the axes touch as on one rank, though none of their
  // coordinates changes by as much as their distance does. At the start they are just beyond the reach of the ghosts, 7.5 mm.
  const auto distance_after = [](MPI_Comm comm) {
    std::vector<RagPiece> spheres{cloth(1, 1), cloth(1, 1)};
    for (const double side : {-1.0, 1.0}) {
      RagPiece& piece = spheres[side < 0 ? 0 : 1];
      piece.centre = side * 2.2e-3 * Vec3{1, 1, 1}, piece.velocity = -side * Vec3{1, 1, 1};
    }
    RagSystem rags(comm, {}, spheres);
    rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), nullptr));
    rags.advance(3e-3);
    return norm(rag_states(rags)[0].centre - rag_states(rags)[1].centre);
  };
  const double alone = distance_after(MPI_COMM_SELF), spread = distance_after(MPI_COMM_WORLD);
  EXPECT_GT(alone, 2e-3) << "they must bounce";
  EXPECT_EQ(spread, alone);
}

TEST(RagRanks, BondsBreakAlikeOnAnyNumberOfRanks) {
  // Requirement: with breakage the same bonds break, both tiles of a bond agree, and whole plus broken stays the number at birth.
  ThrownCloth alone(MPI_COMM_SELF, true), spread(MPI_COMM_WORLD, true);
  alone.advance(500), spread.advance(500);
  const std::vector<BondCount> a = alone.rags.check(), b = spread.rags.check();
  for (std::size_t r = 0; r < a.size(); ++r) EXPECT_EQ(a[r].broken, b[r].broken);
  EXPECT_GT(a[0].broken, 10);
  const RagSheet one = gather_sheet(alone.rags), all = gather_sheet(spread.rags);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_EQ(one.triangles, all.triangles);
  }
}

TEST(RagRanks, ResumedRunEqualsTheUninterruptedOneToTheBit) {
  // Requirement: state, bond marks, contact history and counters come back so that the run goes on as if it had not stopped.
  ThrownCloth whole(MPI_COMM_WORLD, true), first(MPI_COMM_WORLD, true), second(MPI_COMM_WORLD, true);
  whole.advance(600);
  first.advance(300);
  test::by_checkpoint(
      MPI_COMM_WORLD, "rag_ranks", [&](CheckpointWriter& writer) { first.rags.save(writer); },
      [&](CheckpointReader& reader) { second.rags.load(reader); });
  EXPECT_EQ(second.rags.time(), first.rags.time());
  second.advance(300);
  const RagSheet a = gather_sheet(whole.rags), b = gather_sheet(second.rags);
  EXPECT_EQ(largest_difference(a, b), 0);
  EXPECT_EQ(whole.rags.check()[0].broken, second.rags.check()[0].broken);
  EXPECT_EQ(whole.rags.n_sub_steps(), second.rags.n_sub_steps());
}

TEST(RagRanks, RunWrittenOnOneRankResumesOnAll) {
  // Requirement: a checkpoint of one rank goes on upon any number of ranks with the same result.
  const std::string folder =
      (std::filesystem::temp_directory_path() / ("snag_rag_ranks_one_" + std::to_string(size_of(MPI_COMM_WORLD)))).string();
  ThrownCloth whole(MPI_COMM_SELF, true);
  whole.advance(300);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    std::filesystem::remove_all(folder), std::filesystem::create_directories(folder);
    CheckpointWriter writer(MPI_COMM_SELF, folder, {.case_sha256 = "none", .ranks = 1, .time_step = 1, .time = whole.rags.time()});
    whole.rags.save(writer);
    writer.finish();
  }
  MPI_Barrier(MPI_COMM_WORLD);
  ThrownCloth spread(MPI_COMM_WORLD, true);
  {
    CheckpointReader reader(MPI_COMM_WORLD, folder);
    spread.rags.load(reader);
  }
  whole.advance(150), spread.advance(150);
  const RagSheet a = gather_sheet(whole.rags), b = gather_sheet(spread.rags);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_LT(largest_difference(a, b), 1e-12);
  }
  EXPECT_EQ(whole.rags.check()[0].broken, spread.rags.check()[0].broken);
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::remove_all(folder);
}

TEST(RagRanks, RanksWithoutCloth) {
  // Requirement: one particle on many ranks falls by g t^2/2 wherever it is, while it changes hands.
  RagPiece piece = cloth(1, 1);
  piece.velocity = {1, 0, 0};
  RagSystem rags(MPI_COMM_WORLD, {.step = 1e-4, .safety = 1}, {piece});
  rags.set_gravity({0, 0, -10});
  const int size = size_of(MPI_COMM_WORLD);
  for (int k = 0; k < 10; ++k) {
    rags.migrate([size, k](const std::vector<Vec3>& centres) { return std::vector<int>(centres.size(), k % size); });
    EXPECT_EQ(rags.tiles().size(), rank_of(MPI_COMM_WORLD) == k % size ? 1u : 0u);
    rags.advance(0.01);
  }
  const RagState s = rag_states(rags)[0];
  EXPECT_NEAR(s.centre.x, 0.1, 1e-13);
  EXPECT_NEAR(s.centre.z, -0.05, 1e-13);
  EXPECT_NEAR(s.end_to_end, 0, 0);
}

TEST(RagRanks, SheetWiderThanATile) {
  // Requirement: bonds between tiles that lie side by side give the same motion on any number of ranks.
  const auto shaken = [](MPI_Comm comm) {
    RagPiece sheet = cloth(max_tile_columns + 12, 2 * max_tile_rows + 3);
    sheet.spin = {40, 20, 100};
    RagSystem rags(comm, {}, {sheet});
    for (Tile& tile : rags.tiles())
      for (int j = 0; j < tile.ny; ++j)
        for (int i = 0; i < tile.nx; ++i)
          tile.field(Tile::vz)[tile.index(i, j)] += std::sin(0.3 * (tile.column + i)) * std::cos(0.4 * (tile.row + j));
    rags.advance(300 * rags.stable_step());
    return rag_states(rags)[0];
  };
  ASSERT_EQ(tile_grid(max_tile_columns + 12, 2 * max_tile_rows + 3).columns, 2);
  const RagState alone = shaken(MPI_COMM_SELF), spread = shaken(MPI_COMM_WORLD);
  EXPECT_GT(alone.bond_energy, 0.01 * alone.kinetic_energy);
  EXPECT_NEAR(spread.kinetic_energy / alone.kinetic_energy, 1, 1e-12);
  EXPECT_NEAR(spread.bond_energy / alone.bond_energy, 1, 1e-12);
}

TEST(RagRanks, LostBondIsNoticed) {
  // Requirement: a bond that vanishes without being counted as broken ends the run with the invariant's exit code on every rank.
  ThrownCloth run(MPI_COMM_WORLD);
  if (!run.rags.tiles().empty() && rank_of(MPI_COMM_WORLD) == 0) run.rags.tiles()[0].bond_x[run.rags.tiles()[0].index(2, 2)] = 0;
  try {
    run.rags.check();
    FAIL() << "not noticed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::invariant);
  }
}

}  // namespace
}  // namespace snag
