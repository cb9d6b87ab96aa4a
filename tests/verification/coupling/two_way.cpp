// ranks: 1 3
// long ranks: 2 5
// Two-way exchange between rags and a water that is as simple as can be: every cell obeys rho du/dt = f without its
// neighbours.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "coupling/coupled_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

/// Ten spheres of 3 mm and a sheet of 20 x 15 particles of 1 mm radius in a box of 60 x 40 x 80 mm, off its centre so that some kernels
/// meet walls.
std::vector<RagPiece> pieces() {
  std::vector<RagPiece> all;
  for (int b = 0; b < 10; ++b) {
    RagSettings settings(RagSettings::Shape::particle);
    settings.diameter = 3e-3, settings.density = 2000;
    settings.position = {0.008 + 0.005 * b, 0.003 + 0.001 * b, 0.004 + 0.0075 * b};
    settings.velocity = {0.1 * (b % 3 - 1), 0.05 * (b % 4), 0.3 - 0.06 * b};
    all.push_back(make_piece(settings, "test"));
  }
  RagSettings sheet(RagSettings::Shape::rag);
  sheet.length = 40e-3, sheet.width = 30e-3, sheet.radius = 1e-3;
  sheet.position = {0.03, 0.02, 0.045}, sheet.lengthwise = {0, 0.2, 1}, sheet.crosswise = {1, 0.3, 0};
  sheet.velocity = {0, 0.2, 0.1};
  all.push_back(make_piece(sheet, "test"));
  return all;
}

/// The water after a step in which each cell obeys du/dt = f/rho + g: Euler's formula in the first step, then BDF2.
void advance_in_second_order(Flow& flow, double dt, const Vec3& g = {}) {
  const TimeScheme time = bdf(dt, flow.time_step_size);
  std::swap(flow.velocity_older, flow.velocity_old), std::swap(flow.velocity_old, flow.velocity);
  for (int c = 0; c < flow.mesh.n_cells; ++c)
    flow.velocity[c] =
        1 / time.now * (dt * (flow.reaction[c] / flow.density + g) - time.old * flow.velocity_old[c] - time.older * flow.velocity_older[c]);
  flow.mesh.halo.exchange(flow.velocity);
  flow.time_step_size = dt;
}

struct TwoWay {
  Mesh mesh;
  Flow flow;
  RagSystem rags;
  CoupledSolver solver;
  bool is_second_order = false;

  TwoWay(MPI_Comm comm, const std::string& kernel, std::array<int, 3> n = {12, 8, 16}, const std::string& more = "")
      : mesh(structured_box(comm, {0, 0, 0}, {0.06, 0.04, 0.08}, n)),
        flow(mesh),
        rags(comm, {}, pieces()),
        solver(
            read_coupling(
                CaseFile::parse("[coupling]\nkernel = \"" + kernel + "\"\nkernel_width_mm = 5\nforces = [\"published\"]\n" + more).root()),
            rags, flow, [this](double dt) { advance_water(dt); }) {}

  void advance_water(double dt) {
    if (is_second_order) return advance_in_second_order(flow, dt);
    for (int c = 0; c < mesh.n_cells; ++c) flow.velocity[c] += dt / flow.density * flow.reaction[c];
    mesh.halo.exchange(flow.velocity);
  }
  void set_water_velocity(const Vec3& u) { flow.velocity.assign(flow.velocity.size(), u); }
  Vec3 momentum_of_water() const { return momentum(flow.velocity); }
  Vec3 momentum(const std::vector<Vec3>& velocity) const {
    std::vector<Vec3> terms(mesh.n_cells);
    for (int c = 0; c < mesh.n_cells; ++c) terms[c] = flow.density * mesh.cell_volume[c] * velocity[c];
    return sum(mesh.comm, std::span<const Vec3>(terms));
  }
  Vec3 momentum_of_rags() const {
    std::vector<Vec3> terms;
    for (const Tile& tile : rags.tiles())
      for (int k = 0; k < static_cast<int>(tile.exists.size()); ++k) {
        const int i = k % tile.stride - 1, j = k / tile.stride - 1;
        if (i < 0 || i >= tile.nx || j < 0 || j >= tile.ny || tile.exists[k] == 0) continue;
        terms.push_back(rags.rags()[tile.rag].mass * tile.vector(Tile::vx, k));
      }
    return sum(rags.comm(), std::span<const Vec3>(terms));
  }
  double energy_of_water() const {
    std::vector<double> terms(mesh.n_cells);
    for (int c = 0; c < mesh.n_cells; ++c) terms[c] = 0.5 * flow.density * mesh.cell_volume[c] * norm_squared(flow.velocity[c]);
    return sum(mesh.comm, std::span<const double>(terms));
  }
  double fastest_water() const {
    double largest = 0;
    for (int c = 0; c < mesh.n_cells; ++c) largest = std::max(largest, norm(flow.velocity[c]));
    return maximum(mesh.comm, largest);
  }
};

class TwoWayExchange : public testing::TestWithParam<std::string> {};

// Requirement: what the rags lose the water gains: total momentum is kept to 1e-10 of what was exchanged, with every kernel.
TEST_P(TwoWayExchange, MomentumIsKept) {
  TwoWay run(world, GetParam());
  const Vec3 rags_before = run.momentum_of_rags(), before = rags_before + run.momentum_of_water();
  double exchanged = 0;
  for (int n = 0; n < 20; ++n) {
    run.solver.step(5e-4);
    EXPECT_LT(run.solver.report().momentum_exchange, 1e-10);
    exchanged += 5e-4 * norm(run.solver.report().force_on_rags);
  }
  const Vec3 after = run.momentum_of_rags() + run.momentum_of_water();
  EXPECT_LT(norm(after - before), 1e-10 * exchanged);
  EXPECT_GT(norm(run.momentum_of_rags() - rags_before), 0.01 * norm(rags_before))
      << "the water must brake the rags, else the test shows nothing";
  EXPECT_EQ(run.solver.report().particles_outside, 0);
}

// Requirement: with the time scheme of the solver, too, at the end of each step from the first on, when the rags meet the water with slip,
// and with steps that change.
TEST(TwoWay, MomentumIsKeptInSecondOrder) {
  TwoWay run(world, "gaussian");
  run.is_second_order = true;
  const Vec3 before = run.momentum_of_rags() + run.momentum_of_water();
  double exchanged = 0;
  for (const double step : {5e-4, 5e-4, 5e-4, 2e-4, 2e-4, 6e-4, 6e-4}) {
    run.solver.step(step);
    exchanged += step * norm(run.solver.report().force_on_rags);
    EXPECT_LT(norm(run.momentum_of_rags() + run.momentum_of_water() - before), 1e-10 * exchanged) << step;
  }
}

/// A sphere that creeps into water at rest until 1.5 times its time of relaxation, in BDF2 of the water: its velocity over that at the
/// start, less the exact one. The kernel is narrow: its water has the velocity of the cells, not that of the fluxes, which this water
/// lacks.
double error_of_relaxation(int steps) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {0, 0, 0}, {0.08, 0.08, 0.08}, {16, 16, 16});
  Flow flow(mesh);
  RagSettings settings(RagSettings::Shape::particle);
  constexpr double start = 1e-14, width = 1.5e-3;  // m/s, m: the drag is linear, and the sphere stays where it is
  settings.diameter = 4e-3, settings.density = 3000, settings.position = {0.0404, 0.0391, 0.0402}, settings.velocity = {start, 0, 0};
  RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test")});
  const auto advance = [&](double step) { advance_in_second_order(flow, step); };
  const std::string text = "[coupling]\nkernel = \"gaussian\"\nkernel_width_mm = 1.5\nforces = [\"schiller_naumann\"]\n";
  CoupledSolver solver(read_coupling(CaseFile::parse(text).root()), rags, flow, advance);
  const double m = rags.rags()[0].mass, K = 3 * std::numbers::pi * flow.dynamic_viscosity * settings.diameter;

  const auto shape = kernel_shapes().make("gaussian", "test");
  Kernel kernel(*shape, width, mesh);
  kernel.locate(std::vector<Vec3>{settings.position});
  WaterPrediction prediction(flow, width);
  prediction.begin_step(1);  // the first, Euler's: d is A S^T 1 over the density
  const double d = prediction.response(kernel)[0], rate = K * (1 / m + d), end = 1.5 / rate;
  for (int n = 0; n < steps; ++n) solver.step(end / steps);
  const Tile& tile = rags.tiles()[0];
  const double exact = 1 - (1 - std::exp(-1.5)) / (1 + d * m);  // of sphere and water with 1/m and d
  std::printf("  %d steps: velocity of the sphere %.8f of the first, exact %.8f\n", steps,
              tile.vector(Tile::vx, tile.index(0, 0)).x / start, exact);
  return tile.vector(Tile::vx, tile.index(0, 0)).x / start - exact;
}

// Requirement: the exchange is of second order in the step.
TEST(TwoWay, ExchangeIsOfSecondOrder) {
  const double coarse = error_of_relaxation(10), middle = error_of_relaxation(20), fine = error_of_relaxation(40);
  EXPECT_GT(std::log2(coarse / middle), 1.8);
  EXPECT_GT(std::log2(middle / fine), 1.8);
}

// Requirement: where an explicit exchange would be unstable (beta dt/rho > 2 in the cells of a held rag) the water is braked: its energy
// never grows and the force on the rag dies out without changing sign. (A single cell may turn round: kernels feel averages only.)
TEST_P(TwoWayExchange, HeldRagInSmallCellsIsStable) {
  TwoWay run(world, GetParam(), {30, 20, 40}, "[coupling.free_stream_drag]\ndrag_factor = 10\n");
  run.rags.clamp([](std::int64_t) { return true; });
  for (Tile& tile : run.rags.tiles())
    for (int f = Tile::vx; f <= Tile::vz; ++f) std::fill_n(tile.field(f), tile.exists.size(), 0.0);
  run.set_water_velocity({0, 4, 0});
  double last_energy = run.energy_of_water(), last_force = infinity, largest_number = 0;
  for (int n = 0; n < 4; ++n) {
    run.solver.step(0.02);
    largest_number = std::max(largest_number, run.solver.report().max_drag_number);
    const double energy = run.energy_of_water(), force = run.solver.report().force_on_rags.y;
    EXPECT_LT(energy, last_energy);
    EXPECT_GT(force, 0);
    EXPECT_LT(force, last_force);
    last_energy = energy, last_force = force;
  }
  EXPECT_GT(largest_number, 2) << "not stiff: the test shows nothing";
}

// Requirement: a free rag with stiff drag comes to rest relative to the water, bounded on the way, and momentum is kept.
TEST_P(TwoWayExchange, FreeRagInSmallCellsIsStable) {
  TwoWay run(world, GetParam(), {30, 20, 40}, "[coupling.free_stream_drag]\ndrag_factor = 10\n");
  run.set_water_velocity({0, 0, 0.8});
  const Vec3 before = run.momentum_of_rags() + run.momentum_of_water();
  double exchanged = 0, largest_number = 0;
  for (int n = 0; n < 4; ++n) {
    run.solver.step(1e-2);
    EXPECT_LT(run.fastest_water(), 1);
    exchanged += 1e-2 * norm(run.solver.report().force_on_rags);
    largest_number = std::max(largest_number, run.solver.report().max_drag_number);
  }
  EXPECT_LT(norm(run.momentum_of_rags() + run.momentum_of_water() - before), 1e-10 * exchanged);
  EXPECT_GT(largest_number, 0.2);
}

// Requirement: a coupled run does not depend on the number of ranks: 1e-10 after 15 steps in velocities and forces.
TEST_P(TwoWayExchange, RanksDoNotMatter) {
  TwoWay run(world, GetParam()), alone(MPI_COMM_SELF, GetParam());
  for (int n = 0; n < 15; ++n) run.solver.step(5e-4), alone.solver.step(5e-4);
  std::map<std::int64_t, Vec3> by_id;
  for (int c = 0; c < alone.mesh.n_cells; ++c) by_id[alone.mesh.cell_id[c]] = alone.flow.velocity[c];
  for (int c = 0; c < run.mesh.n_cells; ++c)
    EXPECT_LT(norm(run.flow.velocity[c] - by_id.at(run.mesh.cell_id[c])), 1e-10 * alone.fastest_water());
  for (const auto& column : CoupledSolver::columns()) {
    if (column.name == "momentum_exchange_rel") continue;  // round-off of each run
    const double mine = column.value(run.solver.report()), expected = column.value(alone.solver.report());
    EXPECT_NEAR(mine, expected, 1e-10 * std::max(1e-3, std::abs(expected))) << column.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, TwoWayExchange, testing::ValuesIn(kernel_shapes().names()));

/// Velocity of the first particle of a heavy piece that falls in water that it sets in motion, m/s.
Vec3 velocity_of_fall(const RagSettings& settings, const std::string& forces) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {0, 0, 0}, {0.002, 0.004, 0.002}, {10, 20, 10});
  Flow flow(mesh);
  RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test")});
  const auto advance = [&](double step) {
    for (int c = 0; c < mesh.n_cells; ++c) flow.velocity[c] += step / flow.density * flow.reaction[c];
  };
  const std::string text = "[gravity]\nacceleration_m_s2 = [0, -9.81, 0]\n[coupling]\nforces = [\"free_stream_drag\", " + forces + "]\n";
  CoupledSolver solver(read_coupling(CaseFile::parse(text).root()), rags, flow, advance);
  for (int n = 0; n < 40; ++n) solver.step(1e-3);
  const Tile& tile = rags.tiles()[0];
  return tile.vector(Tile::vx, tile.index(0, 0));
}

// Requirement: the law of sheets does not change the motion of pieces that are no sheets, to the bit, in steps of the order of their time
// of relaxation too.
TEST(SheetDragExchange, OtherPiecesKeepTheirMotion) {
  RagSettings sphere(RagSettings::Shape::particle), fibre(RagSettings::Shape::fibre);
  sphere.diameter = 1e-4, sphere.density = 2500, sphere.position = {1e-3, 3e-3, 1e-3};
  fibre.length = 4e-4, fibre.diameter = 1e-4, fibre.position = sphere.position;
  for (const RagSettings& piece : {sphere, fibre}) {
    const Vec3 without = velocity_of_fall(piece, "\"added_mass\""), with = velocity_of_fall(piece, "\"added_mass\", \"sheet_drag\"");
    EXPECT_EQ(with, without);
    EXPECT_LT(without.y, -1e-5) << "it does not fall: the test shows nothing";
  }
}

/// Particles of a density over that of the water fill a share phi of a water driven by the body force rho G; one in the middle of each
/// cell. Returns the accelerations of water and particles over G, least and largest, after the first two steps, which know nothing of the
/// last.
struct Suspension {
  double least = infinity, largest = 0;
  double force_over_weight = 0;  // of the water on all particles, over m G
  Suspension(double phi, double density_ratio, double viscosity) {
    const Mesh mesh = structured_box(world, {0, 0, 0}, {0.06, 0.04, 0.08}, {3, 2, 4});
    Flow flow(mesh);
    flow.dynamic_viscosity = viscosity;
    std::vector<RagPiece> pieces;
    const double cell = 0.02;
    for (int c = 0; c < 24; ++c) {
      RagSettings settings(RagSettings::Shape::particle);
      settings.diameter = std::cbrt(6 * phi / std::numbers::pi) * cell, settings.density = density_ratio * flow.density;
      const int row = c / 3 % 2, layer = c / 6;
      settings.position = cell * Vec3{c % 3 + 0.5, row + 0.5, layer + 0.5};
      pieces.push_back(make_piece(settings, "test"));
    }
    RagSystem rags(world, {}, pieces);
    const double G = 2, dt = 1e-4;  // m/s2, s; all stay in their cells
    const auto advance = [&](double step) { advance_in_second_order(flow, step, {G, 0, 0}); };
    const std::string text = "[coupling]\nkernel = \"cell\"\nforces = [\"free_stream_drag\", \"pressure_gradient\"]\n";
    CoupledSolver solver(read_coupling(CaseFile::parse(text).root()), rags, flow, advance);
    Vec3 speed;
    for (int start = 0; start < 2; ++start) {
      for (int n = 0; n < 3; ++n) solver.step(dt);
      speed = {maximum(world, mesh.n_cells > 0 ? flow.velocity[0].x : -infinity), 0, 0};
      for (Tile& tile : rags.tiles()) for_particles(tile, [&](int k, int, int) { tile.set_vector(Tile::vx, k, speed); });
    }
    const int steps = 100;
    for (int n = 0; n < steps; ++n) solver.step(dt);
    force_over_weight = solver.report().force_on_rags.x / (24 * rags.rags()[0].mass * G);
    const auto note = [&](const Vec3& velocity) {
      const double a = norm(velocity - speed) / (G * dt * steps);
      least = std::min(least, a), largest = std::max(largest, a);
    };
    for (int c = 0; c < mesh.n_cells; ++c) note(flow.velocity[c]);
    for (const Tile& tile : rags.tiles()) for_particles(tile, [&](int k, int, int) { note(tile.vector(Tile::vx, k)); });
    least = minimum(world, least), largest = maximum(world, largest);
  }
};

// Requirement: a mixture under a body force moves as one, with the acceleration of its density: neutral particles to 1e-10 of it whatever
// their drag, heavy ones held by a large viscosity to 1 %.
TEST(PressureGradientExchange, MixtureMovesAsOne) {
  for (const double phi : {0.1, 0.3, 0.5}) {
    const Suspension neutral(phi, 1, 1e-3), heavy(phi, 2, 1e3);
    const double exact = 1 / (1 + phi);
    if (rank_of(world) == 0)
      std::printf("  solid fraction %.1f: neutral 1 %+.1e %+.1e, twice as dense %.4f to %.4f, exact %.4f\n", phi, neutral.least - 1,
                  neutral.largest - 1, heavy.least, heavy.largest, exact);
    EXPECT_NEAR(neutral.least, 1, 1e-10);
    EXPECT_NEAR(neutral.largest, 1, 1e-10);
    EXPECT_NEAR(neutral.force_over_weight, 1, 1e-9);  // all of it by the pressure gradient
    EXPECT_NEAR(heavy.force_over_weight, exact, 0.01 * exact);
    EXPECT_NEAR(heavy.least, exact, 0.01 * exact);
    EXPECT_NEAR(heavy.largest, exact, 0.01 * exact);
  }
}

/// Water that answers to the particle in a known way.
struct AnsweringWater final : FluidField {
  double response = 0;  // d, 1/kg
  Vec3 rate;            // r, m/s2
  TileArrays arrays;
  void sample(std::span<const Tile> tiles, const SampleSet&) override {
    arrays.reset(tiles, sampled::n_core);
    for (std::size_t t = 0; t < tiles.size(); ++t)
      for (std::size_t k = 0; k < tiles[t].exists.size(); ++k) {
        for (int i = 0; i < 3; ++i) arrays.field(t, sampled::change + i)[k] = rate[i];
        arrays.field(t, sampled::response)[k] = response;
      }
  }
  FluidSamples at(std::size_t index, const Tile&, double, double) override {
    const auto vector = [&](int f) { return VectorArray{arrays.field(index, f), arrays.field(index, f + 1), arrays.field(index, f + 2)}; };
    return {.density = 1000,
            .dynamic_viscosity = 1e-3,
            .velocity = vector(sampled::velocity),
            .velocity_rate = vector(sampled::change),
            .start = vector(sampled::start),
            .response = arrays.field(index, sampled::response),
            .velocity_gradient = {vector(sampled::gradient), vector(sampled::gradient + 3), vector(sampled::gradient + 6)}};
  }
};

// Requirement: water and particle relax towards each other as two bodies with a linear drag between them do, free and held; the error
// falls with the third power of the sub-step, and one sub-step far longer than the relaxation takes them to the same velocity.
TEST(WaterPrediction, TwoBodiesRelaxAsTheExactSolution) {
  const FluidForces forces =
      std::move(read_coupling(CaseFile::parse("[coupling]\nforces = [\"schiller_naumann\"]\n").root(), false).forces);
  RagSettings settings(RagSettings::Shape::particle);
  settings.diameter = 1e-3, settings.density = 300, settings.velocity = {1e-9, 0, 0};  // creeping: the drag is linear
  RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test")});
  Tile& tile = rags.tiles()[0];
  const int k = tile.index(0, 0);
  const double m = rags.rags()[0].mass, K = 3 * std::numbers::pi * 1e-3 * 1e-3;
  AnsweringWater water;
  water.response = 0.7 / m, water.rate = {2e-8, 0, 0};
  for (const double is_free : {1.0, 0.0}) {
    tile.free[k] = is_free;
    const double mu = (is_free > 0 ? 1 / m : 0) + water.response, end = 2 / (K * mu);
    const auto impulse = [&](double end_time, int n) {
      FluidLoad load(forces, water, rags.rags());
      double v = 1e-9;
      tile.set_vector(Tile::vx, k, {v, 0, 0});
      load.begin_step(rags.tiles(), 0);
      for (int i = 0; i < n; ++i) {
        tile.set_vector(Tile::fx, k, {});
        load.add(0, tile, end_time / n);
        if (is_free > 0) v += end_time / n * tile.vector(Tile::fx, k).x / m;
        tile.set_vector(Tile::vx, k, {v, 0, 0});
      }
      return load.impulse(0, k).x;
    };
    // w = u - v: dw/dt = r - mu K w, J = integral of K w.
    const double w0 = -1e-9, w_end = water.rate.x / (K * mu), exact = K * (w_end * end + (w0 - w_end) * (1 - std::exp(-2)) / (K * mu));
    const double coarse = std::abs(impulse(end, 8) - exact), fine = std::abs(impulse(end, 16) - exact);
    std::printf("  impulse off by %.2e and %.2e\n", coarse / std::abs(exact), fine / std::abs(exact));
    EXPECT_LT(fine, 1e-3 * std::abs(exact));
    EXPECT_GT(coarse, 6.5 * fine);
    water.rate = {};
    EXPECT_NEAR(impulse(1e5 * end, 1), w0 / mu, 1e-4 * std::abs(w0 / mu)) << "all slip is gone after a long step";
    water.rate = {2e-8, 0, 0};
  }
}

// Requirement: momentum that leaks is found out: an error of 1e-9 of what was exchanged.
TEST(MomentumCheck, FindsLeaks) {
  ExchangeBalance balance{.on_rags = {1, 0, 0}, .on_water = {-1, 0, 1e-9}, .exchanged = 1};
  EXPECT_THROW(check_momentum(balance), Error);
  balance.on_water.z = 0.9e-10;
  EXPECT_NO_THROW(check_momentum(balance));

  const Mesh mesh = structured_box(world, {0, 0, 0}, {1, 1, 1}, {4, 4, 8});
  Flow flow(mesh);
  const auto shape = kernel_shapes().make("gaussian", "test");
  Kernel kernel(*shape, 0.2, mesh);
  Exchange exchange(kernel, flow, true, false);
  const std::vector<Vec3> points{{0.3, 0.4, 0.5}}, impulse{{1, 2, 3}};
  const std::vector<double> volume{1e-9};
  kernel.locate(points);
  EXPECT_NO_THROW(check_momentum(exchange.spread({.volume = volume, .screen = {}, .given = impulse}, 0.1)));
}

// Requirement: solid fraction sums to the volume of the rags, is not clipped, and its maximum is reported.
TEST(SolidFraction, SumsToTheVolumeOfTheRags) {
  TwoWay run(world, "cell", {30, 20, 40});
  run.solver.step(1e-4);
  double volume = 0, largest = 0;
  for (const Rag& rag : run.rags.rags()) volume += rag.hydrodynamic_volume * static_cast<double>(rag.n_particles);
  std::vector<double> terms(run.mesh.n_cells);
  for (int c = 0; c < run.mesh.n_cells; ++c) {
    terms[c] = run.flow.solid_fraction[c] * run.mesh.cell_volume[c];
    largest = std::max(largest, run.flow.solid_fraction[c]);
  }
  EXPECT_NEAR(sum(world, std::span<const double>(terms)), volume, 1e-13 * volume);
  EXPECT_EQ(run.solver.report().max_solid_fraction, maximum(world, largest));
  EXPECT_GT(run.solver.report().max_solid_fraction, 1) << "3 mm spheres in 2 mm cells";
}

}  // namespace
}  // namespace snag
