// ranks: 1 3
// long ranks: 2
// A sphere and a small sheet that fall through the flow solver's own water, in a periodic box: nothing but gravity comes from outside. And
// suspensions that settle in water without a net flow.
#include <gtest/gtest.h>

#include <numbers>

#include "coupling/coupled_solver.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "solver/flow_solver.hpp"
#include "tests/momentum_balance.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

std::vector<RagPiece> pieces() {
  RagSettings sphere(RagSettings::Shape::particle);
  sphere.diameter = 4e-3, sphere.density = 2500, sphere.position = {0.011, 0.02, 0.03};
  RagSettings sheet(RagSettings::Shape::rag);
  sheet.length = 24e-3, sheet.width = 16e-3, sheet.radius = 1e-3, sheet.position = {0.026, 0.02, 0.02};
  sheet.lengthwise = {0, 0.2, 1}, sheet.crosswise = {1, 0.3, 0}, sheet.velocity = {0.1, 0.2, 0};
  return {make_piece(sphere, "test"), make_piece(sheet, "test")};
}

FlowSettings sharp_settings() {
  FlowSettings settings;
  settings.dynamic_viscosity = 0.01;
  settings.momentum_tolerance = settings.pressure_tolerance = settings.pressure_tolerance_intermediate = 1e-11;
  return settings;
}

struct Momentum {
  Vec3 of_rags, weight;  // N s, N: sum m v, sum (m - rho V_h) g
};

Momentum momentum(const RagSystem& rags, double density, const Vec3& g) {
  std::vector<Vec3> terms, weights;
  const ParticleList particles(rags.tiles());
  for (std::size_t b = 0; b < particles.size(); ++b) {
    const Tile& tile = rags.tiles()[particles.tile(b)];
    const Rag& rag = rags.rags()[tile.rag];
    terms.push_back(rag.mass * tile.vector(Tile::vx, particles.place(b)));
    weights.push_back((rag.mass - density * rag.hydrodynamic_volume) * g);
  }
  return {sum(rags.comm(), std::span<const Vec3>(terms)), sum(rags.comm(), std::span<const Vec3>(weights))};
}

// Requirement: what the solver gave its water is what the rags lost, every step, to 1e-10; and the momentum of the rags is what water and
// gravity gave them. The water's force is that at the end of a step: its mean, and half of how it differs from the last mean.
TEST(Settling, MomentumCloses) {
  const Mesh mesh = structured_box(world, {0, 0, 0}, {0.04, 0.04, 0.04}, {12, 12, 12}, {true, true, true});
  for (const char* kernel : {"cell", "gaussian"}) {
    SCOPED_TRACE(kernel);
    FlowSolver water(mesh, sharp_settings(), {});
    water.watch().widen(1, "fall of the spheres");  // m/s
    RagSystem rags(world, {}, pieces());
    const std::string text =
        "[gravity]\nacceleration_m_s2 = [0, 0, -9.81]\n[coupling]\nkernel_width_mm = 5\nforces = [\"published\"]\nkernel = \"" +
        std::string(kernel) + "\"\n";
    MomentumBalance balance;  // of the step, before the history is made ready for the next
    CoupledSolver solver(read_coupling(CaseFile::parse(text).root()), rags, water.flow,
                         [&](double dt) { water.advance(dt), balance = momentum_balance(water); });
    const double dt = 1e-3;
    const Momentum before = momentum(rags, water.flow.density, {0, 0, -9.81});
    Vec3 impulse, mean;  // N s; N on the water over the step
    double exchanged = 0;
    for (int n = 0; n < 10; ++n) {
      solver.step(dt);
      const auto& report = solver.report();
      const Vec3 given = balance.given;
      EXPECT_LT(report.momentum_exchange, 1e-10);
      mean = n == 0 ? given : (given + 0.5 * mean) / 1.5;
      EXPECT_LT(norm(mean + report.force_on_rags), 1e-10 * norm(given));
      EXPECT_LT(norm(balance.residual()), 1e-8 * norm(given)) << "the solver must apply all of it";
      impulse += dt * report.force_on_rags;
      exchanged += dt * norm(report.force_on_rags);
    }
    const Momentum after = momentum(rags, water.flow.density, {0, 0, -9.81});
    const double t = solver.time();
    EXPECT_NEAR(t, 10 * dt, 1e-15);
    EXPECT_LT(norm(after.of_rags - before.of_rags - impulse - t * before.weight), 1e-10 * exchanged);
    EXPECT_EQ(solver.report().particles_outside, 0);
    EXPECT_LT(after.of_rags.z, 0) << "it falls";
  }
}

/// Speed at which spheres of 2 mm settle in creeping flow where they fill a share of each cell and the mixture is at rest, over that of one
/// sphere by Stokes.
double settling_speed(double solid_fraction, const std::string& forces) {
  const double d = 2e-3, excess = 500, mu = 1, cell = d * std::cbrt(std::numbers::pi / 6 / solid_fraction);  // m, kg/m3, Pa s, m
  const std::array<int, 3> n{2, 2, 3};
  const Mesh mesh = structured_box(world, {}, cell * Vec3{2, 2, 3}, n, {true, true, true});
  Flow flow(mesh);
  flow.dynamic_viscosity = mu;
  std::vector<RagPiece> spheres;
  for (int c = 0; c < n[0] * n[1] * n[2]; ++c) {
    RagSettings sphere(RagSettings::Shape::particle);
    sphere.diameter = d, sphere.density = flow.density + excess;
    sphere.position = cell * Vec3{c % n[0] + 0.5, c / n[0] % n[1] + 0.5, c / (n[0] * n[1]) + 0.5};
    spheres.push_back(make_piece(sphere, "test"));
  }
  RagSystem rags(world, {}, spheres);
  const std::string text =
      "[gravity]\nacceleration_m_s2 = [0, 0, -9.81]\n[coupling]\nmode = \"one_way\"\nkernel = \"cell\"\nforces = [" + forces + "]\n";
  CoupledSolver solver(read_coupling(CaseFile::parse(text).root()), rags, flow, [](double) {});
  for (int k = 0; k < 40; ++k) solver.step(1e-4);  // some ten times the time of relaxation
  const Momentum momentum_of = momentum(rags, flow.density, {});
  const double mass = rags.rags()[0].mass * static_cast<double>(spheres.size());
  return -momentum_of.of_rags.z / mass / (excess * 9.81 * d * d / (18 * mu));
}

// Requirement: in water without a net flow a suspension settles with the speed of Richardson and Zaki (1954), epsilon^4.65 of a single
// sphere, by each law of suspensions and by the exponent of volume_fraction; the law of di_felice is 4 % faster, as for a single sphere.
TEST(Settling, SuspensionIsHinderedAsRichardsonAndZaki) {
  const auto expect = [](double solid_fraction, const std::string& forces, double tolerance) {
    const double exact = std::pow(1 - solid_fraction, 4.65), found = settling_speed(solid_fraction, forces);
    if (rank_of(world) == 0)
      std::printf("  solid fraction %.2f, %s: %.4f, Richardson and Zaki %.4f\n", solid_fraction, forces.c_str(), found, exact);
    EXPECT_NEAR(found, exact, tolerance * exact);
  };
  for (const double solid_fraction : {0.05, 0.1}) {
    expect(solid_fraction, "\"ergun_wen_yu\"", 0.01);
    expect(solid_fraction, "\"gidaspow\"", 0.03);
  }
  for (const double solid_fraction : {0.05, 0.2, 0.4}) {
    expect(solid_fraction, "\"di_felice\"", 0.07);
    expect(solid_fraction, "\"schiller_naumann\", \"volume_fraction\"", 0.04);
  }
}

}  // namespace
}  // namespace snag
