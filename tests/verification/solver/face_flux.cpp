// ranks: 1 2
#include <gtest/gtest.h>

#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

/// Steady flow in a cavity of 1 m whose lid has 1 m/s, Re 100, and the step that it was reached with, s.
std::vector<Vec3> steady_velocity(const Mesh& mesh, double step) {
  FlowSettings settings = sharp_settings();
  settings.kinematic_viscosity = 0.01;
  FlowSolver solver(mesh, settings, conditions(R"(
[[boundary]]
patches = ["x0", "x1", "y0", "y1", "z0"]
kind = "wall"
[[boundary]]
patch = "z1"
kind = "moving_wall"
velocity = ["1 m/s", "0 m/s", "0 m/s"]
)"));
  const auto change = [&] {
    return distance(mesh, [&](int c) { return norm_squared(solver.flow.velocity[c] - solver.flow.velocity_old[c]); }) / step;
  };
  do solver.advance(step);
  while (change() > 1e-9 && solver.flow.time < 500);
  EXPECT_LE(change(), 1e-9) << "m/s2; steps of " << step << " s";
  return solver.flow.velocity;
}

}  // namespace

// A steady flow does not depend on the step that it was reached with. Where psi grows with the step, velocities differ by 2 % of the lid's.
TEST(FaceFlux, steady_flow_does_not_depend_on_the_step) {
  const Mesh mesh = tetrahedral_box(MPI_COMM_WORLD, {.distortion = 0.15}, {6, 6, 6});
  const auto of_short_steps = steady_velocity(mesh, 0.02), of_long_steps = steady_velocity(mesh, 0.8);
  const double difference = distance(mesh, [&](int c) { return norm_squared(of_long_steps[c] - of_short_steps[c]); });
  if (rank_of(mesh.comm) == 0) std::printf("steps of 0.02 and 0.8 s: velocities differ by %.1e of the lid's\n", difference);
  EXPECT_LT(difference, 1e-6);
}
