// ranks: 1 3
// long ranks: 2
// A sphere and a small sheet that fall through the flow solver's own water, in a periodic box: nothing but gravity comes from outside.
#include <gtest/gtest.h>

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
// gravity gave them.
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
    Vec3 impulse;
    double exchanged = 0;
    for (int n = 0; n < 10; ++n) {
      solver.step(dt);
      const auto& report = solver.report();
      const Vec3 given = balance.given;
      EXPECT_LT(report.momentum_exchange, 1e-10);
      EXPECT_LT(norm(given + report.force_on_rags), 1e-10 * norm(given));
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

}  // namespace
}  // namespace snag
