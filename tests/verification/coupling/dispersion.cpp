// ranks: 1 3
// long ranks: 2
// Turbulent dispersion by the Langevin equation: variance, correlation time, well-mixed tracers; the same on any number of ranks.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/coupled_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "parallel/session.hpp"
#include "tests/by_checkpoint.hpp"

namespace snag {
namespace {

const std::string dispersion = "[coupling]\nforces = [\"free_stream_drag\", \"turbulent_dispersion\"]\n";

/// Small spheres side by side, so light that they follow the water at once.
std::vector<RagPiece> tracers(int n, double spacing) {
  std::vector<RagPiece> pieces;
  for (int i = 0; i < n; ++i) {
    RagSettings settings(RagSettings::Shape::particle);
    settings.diameter = 2e-6, settings.density = 1000, settings.position = {(i + 0.5) * spacing, 0, 0};
    pieces.push_back(make_piece(settings, "test"));
  }
  return pieces;
}

PrescribedFlow turbulent_water() {
  PrescribedFlow flow;
  flow.density = 1000, flow.kinematic_viscosity = 1e-6;
  flow.turbulent_kinetic_energy = 0.015, flow.dissipation_rate = 0.045;  // sigma = 0.1 m/s, T = 0.1 s
  return flow;
}

/// Velocities or positions of the particles of all tiles.
std::vector<Vec3> vectors(const RagSystem& rags, int field) {
  std::vector<Vec3> all;
  for (const Tile& tile : rags.tiles()) for_particles(tile, [&](int k, int, int) { all.push_back(tile.vector(field, k)); });
  return all;
}

// Requirement: tracers have the variance 2 k/3 in each direction, correlation exp(-t/T), and no drift where k is uniform, within three
// standard errors.
TEST(Dispersion, VarianceAndCorrelationTime) {
  if (size_of(MPI_COMM_WORLD) > 1) GTEST_SKIP() << "one rank is enough";
  const int n = 1500;
  RagSystem rags(MPI_COMM_SELF, {}, tracers(n, 1));
  CoupledSolver solver(read_coupling(CaseFile::parse(dispersion).root(), false), rags, turbulent_water());
  const double T = 0.1, sigma = 0.1, dt = 0.02;
  for (int i = 0; i < 20; ++i) solver.step(dt);
  const std::vector<Vec3> before = vectors(rags, Tile::vx);
  for (int i = 0; i < 5; ++i) solver.step(dt);
  const std::vector<Vec3> after = vectors(rags, Tile::vx);
  double square = 0, product = 0, mean = 0;
  for (int b = 0; b < n; ++b) square += norm_squared(after[b]), product += dot(before[b], after[b]), mean += after[b].x;
  const double variance = square / (3 * n), correlation = product / (3 * n) / (sigma * sigma);
  std::printf("  variance %.4f of 2 k/3, correlation after T %.4f (exact %.4f)\n", variance / (sigma * sigma), correlation, std::exp(-1.0));
  const double standard_error = 1 / std::sqrt(3.0 * n);
  EXPECT_NEAR(variance, sigma * sigma, 3 * std::sqrt(2.0) * standard_error * sigma * sigma);
  EXPECT_NEAR(correlation, std::exp(-5 * dt / T), 3 * 1.2 * standard_error);
  EXPECT_NEAR(mean / n, 0, 3 * sigma / std::sqrt(n));
}

/// Mean place in 0 .. 1 of tracers that began evenly spread between two walls that reflect them, with k rising along x.
double mean_place(const std::string& form, double intensity = 1) {
  const int n = 400;
  RagSystem rags(MPI_COMM_SELF, {}, tracers(n, 1.0 / n));
  PrescribedFlow flow = turbulent_water();
  flow.turbulent_kinetic_energy = 0.015, flow.turbulent_kinetic_energy_gradient = {0.135, 0, 0};  // tenfold from wall to wall
  flow.dissipation_rate = 0.15;
  CoupledSolver solver(read_coupling(CaseFile::parse(dispersion + "[coupling.turbulent_dispersion]\nform = \"" + form +
                                                     "\"\nintensity = " + std::to_string(intensity) + "\n")
                                         .root(),
                                     false),
                       rags, flow);
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 3000; ++i) {
    solver.step(0.01);
    for (Tile& tile : rags.tiles())
      for_particles(tile, [&](int k, int, int) {
        // Elastic walls, for the fluctuation as for the place. Memory: number, q.
        double& x = tile.field(Tile::x)[k];
        if (x >= 0 && x <= 1) return;
        x = x < 0 ? -x : 2 - x;
        tile.particle_state[1 * tile.exists.size() + static_cast<std::size_t>(k)] *= -1;
      });
    if (i < 1000) continue;
    for (const Vec3& x : vectors(rags, Tile::x)) sum += x.x, ++count;
  }
  return sum / count;
}

// Requirement: tracers spread evenly in a turbulence that is ten times as strong at one wall as at the other stay so (well-mixed
// condition); without the drift they do not.
TEST(Dispersion, WellMixed) {
  if (size_of(MPI_COMM_WORLD) > 1) GTEST_SKIP() << "one rank is enough";
  const double with_drift = mean_place("lagrangian"), without = mean_place("eddy");
  std::printf("  mean place %.4f with drift, %.4f without, 0.5 if well mixed\n", with_drift, without);
  EXPECT_NEAR(with_drift, 0.5, 0.015);
  EXPECT_GT(std::abs(without - 0.5), 0.03);
}

// Requirement: so they do where the fluctuation is half or twice that of k.
TEST(Dispersion, WellMixedAtOtherIntensities) {
  if (size_of(MPI_COMM_WORLD) > 1) GTEST_SKIP() << "one rank is enough";
  for (const double intensity : {0.5, 2.0}) {
    const double place = mean_place("lagrangian", intensity);
    std::printf("  intensity %.1f: mean place %.4f\n", intensity, place);
    EXPECT_NEAR(place, 0.5, 0.015) << intensity;
  }
}

/// A small cloth with history and dispersion whose tiles change hands every few steps.
struct WanderingCloth {
  RagSystem rags;
  CoupledSolver solver;
  int steps = 0;
  explicit WanderingCloth(MPI_Comm comm)
      : rags(comm, {},
             [] {
               RagSettings sheet(RagSettings::Shape::rag);
               sheet.length = 0.004, sheet.width = 0.14, sheet.radius = 1e-3, sheet.velocity = {0.2, 0.1, 0};
               sheet.lengthwise = {0, 1, 0}, sheet.crosswise = {-1, 0, 0};  // five tiles along x
               return std::vector<RagPiece>{make_piece(sheet, "test")};
             }()),
        solver(read_coupling(CaseFile::parse("[coupling]\nforces = [\"schiller_naumann\", \"turbulent_dispersion\", \"history\", "
                                             "\"added_mass\"]\n")
                                 .root(),
                             false),
               rags, turbulent_water()) {}
  void step() {
    if (++steps % 3 == 0)
      rags.migrate([&](const std::vector<Vec3>& centres) {
        std::vector<int> owner;
        for (const Vec3& c : centres) owner.push_back((static_cast<int>(std::floor(c.x * 30)) + 5 + steps) % size_of(rags.comm()));
        return owner;
      });
    solver.step(1e-4);
  }
};

// Requirement: what forces remember of a particle goes with it from rank to rank: the run is the same as on one rank, to round-off.
TEST(Dispersion, MemoryMigrates) {
  WanderingCloth spread(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
  ASSERT_GT(alone.rags.tiles().size(), 1u);
  for (int i = 0; i < 20; ++i) spread.step(), alone.step();
  for (const Tile& tile : spread.rags.tiles())
    for (const Tile& same : alone.rags.tiles()) {
      if (same.column != tile.column || same.row != tile.row) continue;
      for_particles(tile, [&](int k, int, int) {
        EXPECT_LT(norm(tile.vector(Tile::x, k) - same.vector(Tile::x, k)), 1e-14);
        EXPECT_LT(norm(tile.vector(Tile::vx, k) - same.vector(Tile::vx, k)), 1e-12);
      });
    }
}

// Requirement: a resumed run equals the one that went on, to the bit, memory of the forces included.
TEST(Dispersion, ResumesToTheBit) {
  WanderingCloth whole(MPI_COMM_WORLD);
  for (int i = 0; i < 7; ++i) whole.step();
  WanderingCloth resumed(MPI_COMM_WORLD);
  test::by_checkpoint(
      MPI_COMM_WORLD, "dispersion", [&](CheckpointWriter& writer) { whole.rags.save(writer), whole.solver.save(writer); },
      [&](CheckpointReader& reader) { resumed.rags.load(reader), resumed.solver.load(reader); });
  resumed.steps = whole.steps;
  for (int i = 0; i < 7; ++i) whole.step(), resumed.step();
  EXPECT_EQ(vectors(whole.rags, Tile::x), vectors(resumed.rags, Tile::x));
  EXPECT_EQ(vectors(whole.rags, Tile::vx), vectors(resumed.rags, Tile::vx));
}

}  // namespace
}  // namespace snag
