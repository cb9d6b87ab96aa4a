// ranks: 1
#include <gtest/gtest.h>

#include "solver/turbulence/turbulence.hpp"
#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double k_start = 0.3, epsilon_start = 0.6, C_2 = 1.92;  // m2/s2, m2/s3

// Without production dk/dt = - epsilon and d epsilon/dt = - C_2 epsilon^2/k: the turnover time grows linearly, k/epsilon = T + (C_2 - 1) t.
double exact_k(double t) { return k_start * std::pow(1 + (C_2 - 1) * t * epsilon_start / k_start, -1 / (C_2 - 1)); }
double exact_epsilon(double t) { return epsilon_start * std::pow(1 + (C_2 - 1) * t * epsilon_start / k_start, -C_2 / (C_2 - 1)); }

FlowSolver decaying(const Mesh& mesh, const Vec3& velocity) {
  FlowSettings settings = sharp_settings();
  settings.initial_velocity = velocity;
  return {mesh,
          settings,
          {},
          read_turbulence(CaseFile::parse(R"(
[turbulence]
model = "k_epsilon"
initial_k = "0.3 m2/s2"
initial_epsilon = "0.6 m2/s3"
)")
                              .root())};
}

double error_after(int steps, double unevenness) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {2, 2, 2}, {true, true, true});
  FlowSolver solver = decaying(mesh, {1, 0.5, 0.2});
  for (int i = 0; i < steps; ++i) solver.advance(1.0 / steps * (1 + (i % 2 ? unevenness : -unevenness)));
  return std::abs(solver.flow.turbulent_kinetic_energy[0] / exact_k(1) - 1) +
         std::abs(solver.flow.dissipation_rate[0] / exact_epsilon(1) - 1);
}

void expect_second_order(const char* name, double unevenness) {
  std::vector<double> h, error;
  for (const int steps : {20, 40, 80, 160}) h.push_back(1.0 / steps), error.push_back(error_after(steps, unevenness));
  EXPECT_GT(observed_order(name, h, error), 1.8);
  EXPECT_LT(error.back(), 1e-3);
}

}  // namespace

// Homogeneous turbulence decays by the exact law of the model, second order in time.
TEST(TurbulenceDecay, second_order) { expect_second_order("decay of turbulence", 0); }

// The same with steps that change size every time.
TEST(TurbulenceDecay, uneven_steps) { expect_second_order("decay of turbulence, uneven steps", 0.3); }

// With steps of a hundred turnover times k and epsilon stay positive without being raised, and fall.
TEST(TurbulenceDecay, huge_step) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {2, 2, 2}, {true, true, true});
  FlowSolver solver = decaying(mesh, {});
  for (int i = 0; i < 20; ++i) {
    const StepReport report = solver.advance(50);
    EXPECT_EQ(report.outer.back().turbulence.raised_cells, 0);
    EXPECT_GT(solver.flow.turbulent_kinetic_energy[0], 0);
    EXPECT_GT(solver.flow.dissipation_rate[0], 0);
    EXPECT_LT(solver.flow.turbulent_kinetic_energy[0], k_start);
  }
}
