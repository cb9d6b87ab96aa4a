// ranks: 1
// long ranks: 2
#include <gtest/gtest.h>

#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double height = 0.5, viscosity = 0.3, gradient = 2;  // m, Pa s, Pa/m

Vec3 parabola(const Vec3& x, double) { return {gradient / (2 * viscosity) * x.z * (height - x.z), 0, 0}; }

/// Advance until the flow is steady.
void settle(FlowSolver& solver) {
  for (int i = 0; i < 80; ++i) solver.advance(0.02);
}

double relative_error(const Flow& flow) { return velocity_error(flow, parabola) / (gradient * height * height / (8 * viscosity)); }

FlowSettings settings_of_channel() {
  FlowSettings settings = sharp_settings();
  settings.dynamic_viscosity = viscosity;
  return settings;
}

const char* const walls = R"(
[[boundary]]
patches = ["z0", "z1"]
kind = "wall"
)";
const char* const sides = R"(
[[boundary]]
patches = ["y0", "y1"]
kind = "symmetry"
)";
const char* const pressure_ends = R"(
[[boundary]]
patch = "x0"
kind = "pressure_outlet"
pressure = "2 Pa"
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
)";

double error_by_body_force(const Mesh& mesh, const std::string& toml) {
  FlowSettings settings = settings_of_channel();
  settings.body_force = {gradient, 0, 0};
  FlowSolver solver(mesh, settings, conditions(toml));
  settle(solver);
  return relative_error(solver.flow);
}

double error_by_pressure(const Mesh& mesh) {
  FlowSolver solver(mesh, settings_of_channel(), conditions(std::string(walls) + sides + pressure_ends));
  settle(solver);
  return relative_error(solver.flow);
}

}  // namespace

// Plane channel flow driven by a body force between periodic ends is the parabola, to second order.
TEST(Poiseuille, body_force) {
  std::vector<double> h, hexahedra, tetrahedra;
  for (const int n : {5, 7, 10}) {
    h.push_back(1.0 / n);
    hexahedra.push_back(
        error_by_body_force(structured_box(MPI_COMM_WORLD, {}, {1, height, height}, {2, 2, n}, {true, true, false}), walls));
    tetrahedra.push_back(error_by_body_force(
        tetrahedral_box(MPI_COMM_WORLD, {.upper = {height, height, height}, .distortion = 0.15}, {n, n, n}, {true, true, false}), walls));
  }
  EXPECT_GT(observed_order("channel by body force, hexahedra", h, hexahedra), 1.9);
  EXPECT_GT(observed_order("channel by body force, tetrahedra", h, tetrahedra), 1.8);
  EXPECT_LT(tetrahedra.back(), 0.02);
}

// Driven by the pressure between two ends, where fluid enters and leaves along the normal, it is the same parabola.
TEST(Poiseuille, pressure_drop) {
  std::vector<double> h, hexahedra, tetrahedra;
  for (const int n : {5, 7, 10}) {
    h.push_back(1.0 / n);
    hexahedra.push_back(error_by_pressure(structured_box(MPI_COMM_WORLD, {}, {1, height, height}, {8, 2, n})));
    tetrahedra.push_back(error_by_pressure(tetrahedral_box(MPI_COMM_WORLD, {.upper = {1, height, height}, .distortion = 0.15}, {n, n, n})));
  }
  EXPECT_GT(observed_order("channel by pressure, hexahedra", h, hexahedra), 1.9);
  EXPECT_GT(observed_order("channel by pressure, tetrahedra", h, tetrahedra), 1.7);
  EXPECT_LT(tetrahedra.back(), 0.02);
}

// What enters through an inlet leaves through the outlet, to round-off of the pressure solve.
TEST(Poiseuille, inlet_equals_outlet) {
  const Mesh mesh = tetrahedral_box(MPI_COMM_WORLD, {.upper = {1, height, height}, .distortion = 0.15}, {8, 6, 6});
  FlowSolver solver(mesh, settings_of_channel(), conditions(std::string(walls) + sides + R"(
[[boundary]]
patch = "x0"
kind = "flow_rate_inlet"
flow_rate = "20 L/s"
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
)"));
  for (int i = 0; i < 5; ++i) {
    const StepReport report = solver.advance(0.01);
    EXPECT_LT(std::abs(report.continuity_global), 1e-12);
    EXPECT_LT(report.continuity_local, 1e-10);
  }
}
