// ranks: 1
// cost: 25
#include <gtest/gtest.h>

#include "tests/verification/solver/developed_turbulence.hpp"
#include "tests/verification/solver/flow_cases.hpp"
#include "tests/verification/solver/pipe_sector.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double radius = 0.1;  // m

/// A pipe with first cells at `y_plus` and no cell thicker than radius/n_core, under the pressure gradient of a friction velocity, advanced
/// until nothing changes. Returns Darcy's friction factor over that of Colebrook's formula at the Reynolds number found, less 1.
double excess_of_friction(int n_core, double y_plus, double friction_velocity, double dt) {
  FlowSettings settings;
  const double nu = settings.viscosity() / settings.density, speed = 23 * friction_velocity;
  settings.convection = "upwind", settings.momentum_tolerance = 1e-6;  // convection along a developed flow is zero
  settings.body_force = {2 * settings.density * friction_velocity * friction_velocity / radius, 0, 0};
  settings.initial_velocity = {speed, 0, 0};
  const Mesh mesh = pipe_sector(rings(n_core, y_plus * nu / friction_velocity, radius));
  const auto with_unit = [](double value, const char* unit) { return "\"" + std::to_string(value) + " " + unit + "\"\n"; };
  const std::string model =
      "[turbulence]\nmodel = \"k_omega_sst\"\ntolerance = 1e-6\ninitial_k = " + with_unit(0.002 * speed * speed, "m2/s2") +
      "initial_epsilon = " + with_unit(2e-4 * std::pow(speed, 3) / radius, "m2/s3");
  FlowSolver solver(mesh, settings, conditions(sector_boundary), read_turbulence(CaseFile::parse(model).root()));
  double before = 0, now = 1;
  int steps = 0;
  for (; steps < 3000 && (steps < 40 || std::abs(now - before) > 1e-6 * dt * speed); ++steps) {
    const StepReport report = solver.advance(dt);
    for (const OuterReport& outer : report.outer) {
      EXPECT_TRUE(outer.momentum.converged);
      for (const auto& equation : outer.turbulence.equations) EXPECT_TRUE(equation.sweeps.converged) << equation.symbol;
    }
    before = now, now = mean_velocity(solver.flow);
  }
  const double Re = 2 * radius * now / nu, friction = 8 * friction_velocity * friction_velocity / (now * now);
  const double found = *std::max_element(solver.flow.y_plus.begin(), solver.flow.y_plus.end()), excess = friction / colebrook(Re) - 1;
  std::printf("%3d cells across, y+ %6.2f: Re %7.0f, friction over Colebrook's - 1: %7.4f; %d steps\n", mesh.n_cells / 2, found, Re, excess,
              steps);
  EXPECT_NEAR(found / y_plus, 1, 0.02);
  return excess;
}

}  // namespace

// With first cells at y+ 0.3 and 1 friction of a smooth pipe is that of Colebrook's formula within 2 % at Re 4.5e5 and 1e5, and with those
// anywhere from y+ 3 to 300 it is within 4 % of that at y+ 1, at steps of hundreds of the time in which water crosses a cell at the wall by
// diffusion.
TEST(SstPipe, friction_at_any_wall_distance) {
  struct Flow {
    double friction_velocity, highest_y_plus;
  };
  for (const Flow& pipe : {Flow{0.0917, 300}, Flow{0.0238, 100}}) {
    const double resolved = excess_of_friction(20, 1, pipe.friction_velocity, 1);
    EXPECT_NEAR(resolved, 0, 0.02);
    EXPECT_NEAR(excess_of_friction(20, 0.3, pipe.friction_velocity, 1), 0, 0.02);
    for (const double y_plus : {3.0, 5.0, 7.0, 11.0, 30.0, 100.0, 300.0}) {
      if (y_plus > pipe.highest_y_plus) continue;
      EXPECT_NEAR(excess_of_friction(y_plus < 50 ? 20 : 10, y_plus, pipe.friction_velocity, 1), resolved, 0.04);
    }
  }
}

// The length of a step does not change the friction of a developed flow.
TEST(SstPipe, step_length) {
  const double reference = excess_of_friction(20, 5, 0.0917, 0.1);
  EXPECT_NEAR(excess_of_friction(20, 5, 0.0917, 2), reference, 1e-3);
}
