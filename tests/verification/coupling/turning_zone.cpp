// ranks: 1 3
// The acceleration of the water that particles feel in a zone that turns.
#include <gtest/gtest.h>

#include "coupling/coupled_solver.hpp"
#include "coupling/kernel_field.hpp"
#include "dem/particles/tile_particles.hpp"
#include "dem/rag_system.hpp"
#include "parallel/sum.hpp"
#include "tests/verification/solver/turning_rings.hpp"

namespace snag {
namespace {

struct Motion {
  const char* name;  // of [rotating_zone] motion
  Vec3 stream;       // added to the rotation, m/s
  bool begun;        // a step was made
};

class SolidBodyRotation : public testing::TestWithParam<Motion> {};

// Requirement: in water that turns like a solid body at 100 rad/s, Du/Dt = -Omega^2 r, and Omega x u where a stream is added: in the zone
// that slides, in one that stands in the turning frame, and in the cells around; before the first step too.
TEST_P(SolidBodyRotation, AcceleratesTowardsTheAxis) {
  const double speed = 100, dt = 1e-7, start = 0.3;
  test::Shells shells = test::plane_rings(0.05, 0.15, 0.25, 48);
  shells.origin = {0.02, -0.01, 0.03};
  Mesh mesh = test::ring_mesh(shells);
  const auto zone = test::turning_rotor(mesh, shells, speed, GetParam().name, start);
  Flow flow(mesh);
  flow.rotating_zone = zone.get();
  const Vec3 omega{0, 0, speed};
  for (int c = 0; c < mesh.n_all_cells(); ++c) {
    const Vec3 r = mesh.cell_centre[c] - shells.origin, u = GetParam().stream + cross(omega, r);
    Vec3 rate;  // of a cell that turns, or stands in the turning frame
    if (mesh.cell_zone[c] == zone->zone()) rate = cross(omega, cross(omega, r)) - (zone->slides() ? Vec3{} : cross(omega, u));
    flow.velocity[c] = u;
    flow.velocity_old[c] = u - dt * rate;
    flow.velocity_gradient[c] = {Vec3{0, -speed, 0}, Vec3{speed, 0, 0}, Vec3{}};
  }
  const auto shape = kernel_shapes().make("cell", "test");
  Kernel kernel(*shape, 1e-3, mesh);
  std::vector<RagPiece> pieces;
  for (const double r : {0.1, 0.2}) {
    RagSettings settings(RagSettings::Shape::particle);
    settings.diameter = 1e-3, settings.density = 1000, settings.position = shells.origin + Vec3{0.6 * r, 0.8 * r, 0.05};
    pieces.push_back(make_piece(settings, "test"));
  }
  const RagSystem rags(MPI_COMM_WORLD, {}, pieces);
  WaterPrediction prediction(flow, 0);
  prediction.begin_step(dt);
  if (GetParam().begun) flow.time_step_size = dt, prediction.end_step();
  prediction.begin_step(dt);
  KernelField field(flow, kernel, rags.rags(), prediction, false);
  field.sample(rags.tiles(), {.material_acceleration = true});
  EXPECT_EQ(kernel.n_outside(), 0);
  for (std::size_t t = 0; t < rags.tiles().size(); ++t) {
    const FluidSamples fluid = field.at(t, rags.tiles()[t], 0, 0);
    for_particles(rags.tiles()[t], [&](int k, int, int) {
      const Vec3 place = rags.tiles()[t].vector(Tile::x, k), u = GetParam().stream + cross(omega, place - shells.origin);
      EXPECT_LT(norm(fluid.velocity[k] - u), 1e-10 * norm(u)) << "at the particle, not at the centre of its cell";
      const Vec3 exact = cross(omega, fluid.velocity[k]), found = fluid.material_acceleration[k];
      std::printf("  at %.2f m/s: Du/Dt %.2f along Omega x u, exact %.2f m/s2\n", norm(fluid.velocity[k]), dot(found, unit(exact)),
                  norm(exact));
      EXPECT_LT(norm(found - exact), 1e-4 * norm(exact));
      EXPECT_GT(norm(exact), 600);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, SolidBodyRotation,
                         testing::Values(Motion{"sliding", {}, true}, Motion{"sliding", {3, -2, 0}, true}, Motion{"frame", {}, true},
                                         Motion{"frame", {3, -2, 0}, true}, Motion{"sliding", {}, false}, Motion{"frame", {}, false}),
                         [](const auto& motion) {
                           const Motion& m = motion.param;
                           return m.name + std::string(m.begun ? "" : "_at_the_start") + (m.stream == Vec3{} ? "" : "_in_a_stream");
                         });

/// Water that turns as a solid does, in a ring that turns with it and in one at rest.
struct TurningWater {
  static constexpr double speed = 20 * test::pi;  // 1/s
  test::Shells shells = test::plane_rings(0.05, 0.15, 0.25, 96);
  Mesh mesh = test::ring_mesh(shells);
  std::unique_ptr<RotatingZone> zone = test::turning_rotor(mesh, shells, speed);
  Flow flow{mesh};

  TurningWater() {
    flow.rotating_zone = zone.get();
    set_velocity();
    flow.velocity_older = flow.velocity_old = flow.velocity;
    for (Mat3& G : flow.velocity_gradient) G = {Vec3{0, -speed, 0}, Vec3{speed, 0, 0}, Vec3{}};
  }
  void set_velocity() {
    const auto u = [&](const Vec3& x) { return cross({0, 0, speed}, x - shells.origin); };
    for (int c = 0; c < mesh.n_all_cells(); ++c) flow.velocity[c] = u(mesh.cell_centre[c]);
    flow.flux.resize(static_cast<std::size_t>(mesh.n_faces));
    for (int f = 0; f < mesh.n_faces; ++f) flow.flux[f] = dot(u(mesh.face_centre[f]), mesh.face_vector[f]);
  }
  void advance(double dt) {
    flow.velocity_older = flow.velocity_old, flow.velocity_old = flow.velocity;
    flow.time += dt, flow.time_step_size = dt;
    zone->mesh().turn(zone->angle(flow.time));
    set_velocity();
  }
};

// Requirement: a neutral cloth in water that turns as a solid, across the radius and along it, in the zone that turns and in the one at
// rest, is at 0.1 % of its radius after a turn of 100 steps. (Water that lags behind by a step throws it out by 20 %.)
TEST(SolidBodyRotation, NeutralClothStaysAtItsRadius) {
  for (const double radius : {0.1, 0.2})
    for (const Vec3& lengthwise : {Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
      TurningWater water;
      RagSettings settings(RagSettings::Shape::rag);
      settings.length = 0.04, settings.width = 0.03, settings.radius = 2e-3;
      settings.mass_per_area = 998.2 * settings.thickness;
      settings.position = water.shells.origin + Vec3{radius, 0, 0.05}, settings.lengthwise = lengthwise, settings.crosswise = {0, 0, 1};
      settings.velocity = {0, water.speed * radius, 0}, settings.spin = {0, 0, water.speed};
      RagSystem rags(MPI_COMM_WORLD, {}, {make_piece(settings, "test")});
      Coupling coupling = read_coupling(CaseFile::parse("[coupling]\nkernel_width_mm = 12\n").root());
      CoupledSolver solver(std::move(coupling), rags, water.flow, [&](double dt) { water.advance(dt); });
      const auto distance = [&] {
        Vec3 sum_of_places;
        for (const Tile& tile : rags.tiles())
          for_particles(tile, [&](int k, int, int) { sum_of_places += tile.vector(Tile::x, k) - water.shells.origin; });
        const Vec3 mean = sum(MPI_COMM_WORLD, std::span<const Vec3>(&sum_of_places, 1)) / static_cast<double>(rags.rags()[0].n_particles);
        return std::hypot(mean.x, mean.y);
      };
      const double before = distance();
      for (int n = 0; n < 100; ++n) solver.step(2 * test::pi / water.speed / 100);
      std::printf("  at %.1f m, %s: %.5f of the radius after a turn\n", radius, lengthwise.y > 0 ? "along the stream" : "across it",
                  distance() / before);
      EXPECT_NEAR(distance() / before, 1, 1e-3);
    }
}

// Requirement: what the water's answer was missed by, a vector that the water carries, turns by the angle of the step in the zone that
// turns and not in the one at rest.
TEST(MissedRates, TurnWithTheZone) {
  TurningWater water;
  const Vec3 force{0, 300, 0};  // N/m3
  const double angle = 0.1;
  for (const double radius : {0.1, 0.2}) {
    const auto shape = kernel_shapes().make("gaussian", "test");
    Kernel kernel(*shape, 0.012, water.mesh);
    kernel.locate(std::vector<Vec3>{water.shells.origin + Vec3{radius, 0, 0.05}});  // one particle of each rank
    WaterPrediction prediction(water.flow, 0.012);
    prediction.begin_step(angle / water.speed);
    water.flow.reaction.assign(static_cast<std::size_t>(water.mesh.n_cells), force);
    const std::vector<double> response = prediction.response(kernel);
    const Vec3 rate = prediction.missed_rates(kernel, response, std::vector<Vec3>(1))[0];
    const Vec3 missed = force / water.flow.density;  // the first step: implicit Euler
    const Vec3 expected = radius < 0.15 ? rotation({0, 0, 1}, angle) * missed : missed;
    EXPECT_LT(norm(rate - expected), 1e-3 * norm(missed)) << radius << " m";
  }
}

}  // namespace
}  // namespace snag
