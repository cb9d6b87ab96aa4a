// ranks: 1 2
// long ranks: 3
// Vortices that a stream carries through a convective outlet: an exact solution in an endless domain, of which the mesh is a part.
#include <gtest/gtest.h>

#include "solver/monitors.hpp"
#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double viscosity = 0.01, stream = 2, end_time = 3;

// Taylor and Green's vortices in a frame that moves along x with the stream.
Vec3 exact_velocity(const Vec3& x, double t) {
  const double decay = std::exp(-2 * viscosity * t), way = x.x - stream * t;
  return {stream + decay * std::sin(way) * std::cos(x.z), 0, -decay * std::cos(way) * std::sin(x.z)};
}
double exact_pressure(const Vec3& x, double t) {
  return 0.25 * 1.2 * std::exp(-4 * viscosity * t) * (std::cos(2 * (x.x - stream * t)) + std::cos(2 * x.z));
}

struct Errors {
  double velocity, pressure, imbalance;
};

/// At the end, when the vortices of the start have left; the largest imbalance of all steps, of what enters.
Errors errors_with(const std::string& outlet, int n, int steps) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {pi, 1, 2 * pi}, {n / 2, 2, n}, {false, true, true});
  FlowSettings settings = sharp_settings();
  settings.kinematic_viscosity = viscosity;
  std::vector<PatchBoundary> all = conditions("[[boundary]]\npatch = \"x1\"\nkind = \"" + outlet + "\"\n");
  add_exact(all, "x0", exact_velocity, true);
  FlowSolver solver(mesh, settings, std::move(all));
  for (int c = 0; c < mesh.n_cells; ++c) {
    solver.flow.velocity[c] = exact_velocity(mesh.cell_centre[c], 0);
    solver.flow.pressure[c] = exact_pressure(mesh.cell_centre[c], 0);
  }
  double imbalance = 0;
  for (int i = 0; i < steps; ++i) {
    solver.advance(end_time / steps);
    const double in = -flow_rate(solver.flow, mesh.patch_index("x0")), out = flow_rate(solver.flow, mesh.patch_index("x1"));
    imbalance = std::max(imbalance, std::abs(out / in - 1));
  }
  return {velocity_error(solver.flow, exact_velocity), pressure_error(solver.flow, exact_pressure), imbalance};
}

}  // namespace

// The slope of the pressure is first order in the cells, and so is the flow at last; what enters leaves.
TEST(ConvectiveOutlet, VorticesLeave) {
  std::vector<double> h, velocity, pressure;
  for (const int n : {16, 24, 32, 48}) {
    const Errors errors = errors_with("convective_outlet", n, 3 * n);
    h.push_back(1.0 / n), velocity.push_back(errors.velocity), pressure.push_back(errors.pressure);
    EXPECT_LT(errors.imbalance, 1e-9);
  }
  EXPECT_GT(observed_order("velocity", h, velocity), 0.8);
  EXPECT_GT(observed_order("pressure", h, pressure), 0.8);
  EXPECT_LT(velocity.back(), 0.01);
}

// A uniform pressure at the outlet reflects them: its error is several times as large.
TEST(ConvectiveOutlet, PressureOutletReflectsThem) {
  const Errors convective = errors_with("convective_outlet", 32, 96), fixed = errors_with("pressure_outlet", 32, 96);
  EXPECT_GT(fixed.velocity, 3 * convective.velocity);
  EXPECT_GT(fixed.pressure, 3 * convective.pressure);
}

// Steps in which the stream crosses two cells: bounded, and no worse than the step allows with a pressure outlet.
TEST(ConvectiveOutlet, LargeSteps) {
  EXPECT_LT(errors_with("convective_outlet", 32, 16).velocity, errors_with("pressure_outlet", 32, 16).velocity);
}
