// ranks: 1
// long ranks: 2
#include <gtest/gtest.h>

#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double viscosity = 0.02, end_time = 1;

// u = sin x cos z, w = - cos x sin z, p = rho/4 (cos 2x + cos 2z), decaying with exp(-2 nu t): a solution of the full equations in a
// periodic box.
Vec3 exact_velocity(const Vec3& x, double t) {
  const double decay = std::exp(-2 * viscosity * t);
  return {decay * std::sin(x.x) * std::cos(x.z), 0, -decay * std::cos(x.x) * std::sin(x.z)};
}
double exact_pressure(const Vec3& x, double t) {
  return 0.25 * 1.2 * std::exp(-4 * viscosity * t) * (std::cos(2 * x.x) + std::cos(2 * x.z));
}

struct Errors {
  double velocity, pressure, decay_rate;
};

Errors errors_on(const Mesh& mesh, int steps) {
  FlowSettings settings = sharp_settings();
  settings.kinematic_viscosity = viscosity;
  FlowSolver solver(mesh, settings, {});
  for (int c = 0; c < mesh.n_cells; ++c) {
    solver.flow.velocity[c] = exact_velocity(mesh.cell_centre[c], 0);
    solver.flow.pressure[c] = exact_pressure(mesh.cell_centre[c], 0);
  }
  const auto energy = [&] { return std::pow(distance(mesh, [&](int c) { return norm_squared(solver.flow.velocity[c]); }), 2); };
  const double before = energy();
  for (int i = 0; i < steps; ++i) solver.advance(end_time / steps);
  return {velocity_error(solver.flow, exact_velocity), pressure_error(solver.flow, exact_pressure),
          std::log(before / energy()) / (2 * end_time)};
}

void check(const char* name, const std::function<Mesh(int)>& mesh_of, const std::vector<int>& sizes) {
  std::vector<double> h, velocity, pressure, rate;
  for (const int n : sizes) {
    const Errors errors = errors_on(mesh_of(n), n);
    h.push_back(1.0 / n), velocity.push_back(errors.velocity), pressure.push_back(errors.pressure);
    rate.push_back(std::abs(errors.decay_rate - 2 * viscosity));
  }
  EXPECT_GT(observed_order((std::string("velocity, ") + name).c_str(), h, velocity), 1.8);
  EXPECT_GT(observed_order((std::string("pressure, ") + name).c_str(), h, pressure), 1.1);
  EXPECT_GT(observed_order((std::string("decay rate, ") + name).c_str(), h, rate), 1.8);
  EXPECT_LT(rate.back(), 0.12 * 2 * viscosity);
}

}  // namespace

// The Taylor-Green vortex in a periodic box decays at its exact rate, to second order, on hexahedra.
TEST(TaylorGreen, hexahedra) {
  check("hexahedra",
        [](int n) {
          return structured_box(MPI_COMM_WORLD, {}, {2 * pi, 1, 2 * pi}, {n, 2, n}, {true, true, true});
        },
        {16, 24, 32, 48});
}

// The same on tetrahedra.
TEST(TaylorGreen, tetrahedra) {
  check("tetrahedra",
        [](int n) {
          return tetrahedral_box(MPI_COMM_WORLD, {.upper = {2 * pi, pi, 2 * pi}, .distortion = 0.1}, {n, n / 2, n}, {true, true, true});
        },
        {8, 12, 16, 20});
}
