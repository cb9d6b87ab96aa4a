// ranks: 1 2
// long ranks: 3
// timeout: 600
// Inlets with a total or a static pressure, against the column of water without friction between them and an outlet.
#include <gtest/gtest.h>

#include "solver/monitors.hpp"
#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

/// A column 2 m long between slip walls, density 1.2; `inlet`: keys of the inlet.
std::string column(const std::string& inlet) {
  return R"(
[[boundary]]
patches = ["y0", "y1", "z0", "z1"]
kind = "symmetry"
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
[[boundary]]
patch = "x0"
kind = "pressure_inlet"
)" + inlet;
}

FlowSettings settings() {
  FlowSettings chosen = sharp_settings();
  chosen.kinematic_viscosity = 1e-3;
  return chosen;
}

double speed_at(const Mesh& mesh, const std::string& inlet, double end, int steps) {
  FlowSolver solver(mesh, settings(), conditions(column(inlet)));
  for (int i = 0; i < steps; ++i) solver.advance(end / steps);
  return flow_rate(solver.flow, mesh.patch_index("x1"));
}

}  // namespace

// p_0 = rho/2 drives a column of length L from rest: rho L du/dt = p_0 - rho u^2/2, so that u = tanh(t/(2 L)) m/s; and it ends at 1 m/s.
TEST(PressureInlet, total) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {2, 1, 1}, {8, 3, 3});
  const double exact = std::tanh(3.0 / 4);
  std::vector<double> h, error;
  for (const int steps : {30, 60, 120})
    h.push_back(3.0 / steps), error.push_back(std::abs(speed_at(mesh, "pressure_Pa = 0.6", 3, steps) - exact));
  EXPECT_LT(error.back(), 1e-4);
  EXPECT_GT(observed_order("speed behind a total pressure, in time", h, error), 1.8);
  EXPECT_NEAR(speed_at(mesh, "pressure_Pa = 0.6", 40, 800), 1, 1e-6);
}

// Steps in which the water crosses five cells: the end is the same to the last digits, on every face of the inlet. Of twelve cells: the
// dynamic head does not run away (taken whole it does so within 60 steps).
TEST(PressureInlet, large_steps) {
  const Mesh mesh = tetrahedral_box(MPI_COMM_WORLD, {.upper = {2, 1, 1}, .distortion = 0.15}, {16, 4, 4});
  FlowSolver solver(mesh, settings(), conditions(column("pressure_Pa = 0.6")));
  const int x0 = mesh.patch_index("x0"), x1 = mesh.patch_index("x1");
  const auto run = [&](double dt, int steps) {
    StepReport report;
    for (int i = 0; i < steps; ++i) report = solver.advance(dt);
    return report.courant_max;
  };
  const auto largest_deviation = [&] {
    double deviation = 0;
    for (int f = mesh.patches[x0].first; f < mesh.patches[x0].end(); ++f)
      deviation = std::max(deviation, std::abs(-solver.flow.flux[f] / norm(mesh.face_vector[f]) - 1));
    return maximum(mesh.comm, deviation);
  };
  EXPECT_GT(run(0.1, 400), 4.9);
  EXPECT_LT(largest_deviation(), 1e-5);
  EXPECT_GT(run(0.25, 100), 12);
  EXPECT_LT(largest_deviation(), 0.2);
  EXPECT_NEAR(flow_rate(solver.flow, x1), 1, 0.01);
}

// Steps in which the water moves one and five lengths of its column: the flow comes to its end and stays there.
TEST(PressureInlet, steps_longer_than_the_column) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {2, 1, 1}, {1, 1, 1});
  for (const double step : {2.0, 10.0}) EXPECT_NEAR(speed_at(mesh, "pressure_Pa = 0.6", 400 * step, 400), 1, 1e-6) << step;
}

// A static pressure of 0.6 Pa speeds the column up at p/(rho L) = 0.25 m/s2 without end; water that flows back leaves at p_0 itself, and
// enters through the outlet from rest: u = -tanh(t/(2 L)).
TEST(PressureInlet, given_as_static) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {2, 1, 1}, {8, 3, 3});
  EXPECT_NEAR(speed_at(mesh, "pressure_Pa = 0.6\ntotal = false", 3, 60), 0.75, 1e-6);
  EXPECT_NEAR(speed_at(mesh, "pressure_Pa = -0.6", 3, 120), -std::tanh(3.0 / 4), 0.01);
}

// Pressure that rises in time T drives the column to p_0 T/(2 rho L), then on.
TEST(PressureInlet, ramp) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {2, 1, 1}, {8, 3, 3});
  EXPECT_NEAR(speed_at(mesh, "pressure_Pa = 0.6\ntotal = false\nramp_s = 2", 3, 300), 0.25 * (1 + 1), 1e-3);
}
