// ranks: 1
#include <gtest/gtest.h>

#include "solver/monitors.hpp"
#include "tests/verification/solver/flow_cases.hpp"
#include "tests/verification/solver/planar_grid.hpp"

using namespace snag;
using namespace snag::test;

namespace {

const char* const model = R"(
[turbulence]
model = "k_epsilon"
tolerance = 1e-11
initial_k = "0.01 m2/s2"
initial_epsilon = "0.02 m2/s3"
)";

std::string moving_wall(const std::string& patch, const std::string& motion) {
  return "[[boundary]]\npatch = \"" + patch + "\"\nkind = \"moving_wall\"\n" + motion + "\n";
}

std::string velocity(const Vec3& u) {
  const auto component = [](double value) { return "\"" + std::to_string(value) + " m/s\""; };
  return "velocity = [" + component(u.x) + ", " + component(u.y) + ", " + component(u.z) + "]";
}

struct Plates {
  Vec3 lower, upper;  // force of the water on them, N
};

/// Plates 0.1 m apart, of 0.04 m2 each, after `steps` steps from rest relative to their mean velocity.
Plates between_plates(const Vec3& lower, const Vec3& upper, int steps) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {0.2, 0.2, 0.1}, {2, 2, 20}, {true, true, false});
  FlowSettings settings;
  settings.momentum_tolerance = 1e-10, settings.pressure_tolerance = 1e-10, settings.initial_velocity = 0.5 * (lower + upper);
  FlowSolver solver(mesh, settings, conditions(moving_wall("z0", velocity(lower)) + moving_wall("z1", velocity(upper))),
                    read_turbulence(CaseFile::parse(model).root()));
  for (int i = 0; i < steps; ++i) solver.advance(0.5);
  return {patch_force(solver.flow, mesh.patch_index("z0"), {}).friction, patch_force(solver.flow, mesh.patch_index("z1"), {}).friction};
}

struct Cylinders {
  double inner, outer;  // torque of the water on them, N m
  double across;        // largest velocity across the walls in the cells at them, over that along the walls
};

/// A ring of water between cylinders of 0.1 m and 0.15 m radius, 0.02 m high, after `steps` steps; all speeds in 1/s.
Cylinders between_cylinders(double inner, double outer, double water, int steps, double dt = 0.001) {
  constexpr int n_around = 64, n_across = 12;
  PlanarGrid ring{.n_i = n_around, .n_j = n_across, .closed = true, .depth = 0.02};
  ring.node = [](int i, int j) {
    const double angle = -2 * pi * i / n_around, r = 0.1 + 0.05 * j / n_across;
    return Vec3{r * std::cos(angle), r * std::sin(angle), 0};
  };
  ring.patches = {"inner", "outer"};
  ring.patch = [](int, int, GridSide side) { return side == GridSide::low_j ? "inner" : "outer"; };
  const Mesh mesh = plane_mesh(ring);
  const auto speed = [](double value) { return "rotation_speed = \"" + std::to_string(value) + " rad/s\""; };
  FlowSolver solver(mesh, {},
                    conditions(moving_wall("inner", speed(inner)) + moving_wall("outer", speed(outer)) +
                               "[[boundary]]\npatch = \"sides\"\nkind = \"symmetry\"\n"),
                    read_turbulence(CaseFile::parse(model).root()));
  for (int c = 0; c < mesh.n_cells; ++c) solver.flow.velocity[c] = cross(Vec3{0, 0, water}, mesh.cell_centre[c]);
  for (int i = 0; i < steps; ++i) solver.advance(dt);
  const auto torque = [&](const char* patch) { return patch_force(solver.flow, mesh.patch_index(patch), {}).torque().z; };
  double across = 0;
  for (const char* name : {"inner", "outer"}) {
    const Patch& patch = mesh.patches[mesh.patch_index(name)];
    for (int f = patch.first; f < patch.end(); ++f) {
      const Vec3& u = solver.flow.velocity[mesh.owner[f]];
      across = std::max(across, std::abs(dot(u, unit(mesh.face_vector[f]))) / norm(u));
    }
  }
  return {torque("inner"), torque("outer"), across};
}

void expect_same(const Vec3& a, const Vec3& b, double tolerance) { EXPECT_LT(norm(a - b), tolerance * norm(b)); }

}  // namespace

// Plates that slide past each other feel the same shear at every moment whichever of them moves, and whether all moves together or not;
// in the steady state the two shears are equal.
TEST(TurbulentCouette, plates) {
  const Vec3 U{2, 0.5, 0}, all{3, -1, 0};
  for (const int steps : {1, 5, 200}) {
    const Plates reference = between_plates({}, U, steps), together = between_plates(all, all + U, steps),
                 other = between_plates(U, {}, steps);
    std::printf("after %d steps: on the lower plate %.6f N, on the upper %.6f N\n", steps, reference.lower.x, reference.upper.x);
    EXPECT_GT(reference.lower.x, 0);
    expect_same(together.lower, reference.lower, 1e-7), expect_same(together.upper, reference.upper, 1e-7);
    expect_same(other.lower, -1 * reference.lower, 1e-7), expect_same(other.upper, -1 * reference.upper, 1e-7);
    expect_same(reference.lower, -1 * reference.upper, 1e-7);
  }
  const Plates reference = between_plates({}, U, 200), against = between_plates(-0.5 * U, 0.5 * U, 200);
  expect_same(against.lower, reference.lower, 1e-5);
}

// Water that turns with both cylinders as one body exerts no shear on them; where one of them stops, the shear that sets in is that on a
// cylinder that starts in water at rest, and the other direction of rotation gives the opposite of it.
TEST(TurbulentCouette, cylinders) {
  const Cylinders together = between_cylinders(20, 20, 20, 100), stopped = between_cylinders(20, 0, 20, 1),
                  started = between_cylinders(0, -20, 0, 1), opposite = between_cylinders(0, 20, 0, 1);
  std::printf("torque on the outer cylinder: %.3e N m together, %.6f stopped, %.6f started, %.6f opposite\n", together.outer, stopped.outer,
              started.outer, opposite.outer);
  EXPECT_GT(stopped.outer, 0);
  EXPECT_LT(std::abs(together.inner) + std::abs(together.outer), 0.02 * stopped.outer);
  EXPECT_NEAR(started.outer / stopped.outer, 1, 0.03);
  EXPECT_NEAR(opposite.outer / started.outer, -1, 1e-6);
}

// Requirement: the pressure at a curved wall at rest leads the water along the wall. The cells at the walls, 4 mm wide, have a velocity
// across them of at most 6 % of that along the walls, and the torques of the two cylinders differ by less than a fifth. Measured: 5.1 % and
// 15 %; with zero slope of the pressure at walls at rest 8.7 % and 58 %.
TEST(TurbulentCouette, velocity_across_curved_walls) {
  const Cylinders steady = between_cylinders(20, 0, 10, 1500, 0.1);
  std::printf("torque on the inner cylinder %.6f, on the outer %.6f N m; velocity across the walls %.4f of that along them\n", steady.inner,
              steady.outer, steady.across);
  EXPECT_LT(steady.across, 0.06);
  EXPECT_NEAR(steady.inner / steady.outer, -1, 0.2);
}
