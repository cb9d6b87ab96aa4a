// ranks: 1 3
// long ranks: 2 5
// timeout: 900
#include <gtest/gtest.h>

#include <map>

#include "solver/monitors.hpp"
#include "tests/verification/solver/flow_cases.hpp"
#include "tests/verification/solver/take_over.hpp"

using namespace snag;
using namespace snag::test;

namespace {

const char* const models[] = {"k_epsilon", "k_omega_sst"};

const char* const duct = R"(
[[boundary]]
patches = ["y0", "y1", "z0"]
kind = "wall"
[[boundary]]
patch = "z1"
kind = "moving_wall"
velocity = ["0.5 m/s", "0.3 m/s", "0 m/s"]
[[boundary]]
patch = "x0"
kind = "flow_rate_inlet"
flow_rate = "1 m3/s"
turbulence_intensity = 0.1
turbulence_length_scale = "5 cm"
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
)";

struct Duct {
  Mesh mesh;
  FlowSolver solver;
  std::int64_t raised = 0;
  Duct(MPI_Comm comm, const std::string& model)
      : mesh(tetrahedral_box(comm, {.upper = {2, 1, 1}, .distortion = 0.15}, {8, 4, 5})),
        solver(mesh, settings(), conditions(duct),
               read_turbulence(CaseFile::parse("[turbulence]\ntolerance = 1e-11\nmodel = \"" + model + "\"\n").root())) {}
  static FlowSettings settings() {
    FlowSettings chosen = sharp_settings();
    chosen.kinematic_viscosity = 1e-5;
    return chosen;
  }
  void advance(int steps) {
    for (int i = 0; i < steps; ++i)
      for (const OuterReport& outer : solver.advance(0.03).outer) raised += outer.turbulence.raised_cells;
  }
};

/// Largest difference from the same cell in a run on one rank, over the largest value.
double difference(const Duct& shared_run, const Duct& single_run, const std::vector<double> Flow::*field) {
  std::map<std::int64_t, int> cell_of_id;
  for (int c = 0; c < single_run.mesh.n_cells; ++c) cell_of_id[single_run.mesh.cell_id[c]] = c;
  double largest = 0, off = 0;
  for (int c = 0; c < shared_run.mesh.n_cells; ++c) {
    const double same = (single_run.solver.flow.*field)[cell_of_id.at(shared_run.mesh.cell_id[c])];
    off = std::max(off, std::abs((shared_run.solver.flow.*field)[c] - same)), largest = std::max(largest, std::abs(same));
  }
  return maximum(MPI_COMM_WORLD, off) / maximum(MPI_COMM_WORLD, largest);
}

}  // namespace

// With each model k, epsilon, nu_t and pressure after 50 steps on several ranks are those of one rank within 1e-6.
TEST(TurbulentDuct, ranks) {
  for (const char* const model : models) {
    Duct shared_run(MPI_COMM_WORLD, model), single_run(MPI_COMM_SELF, model);
    shared_run.advance(50), single_run.advance(50);
    for (const auto field : {&Flow::turbulent_kinetic_energy, &Flow::dissipation_rate, &Flow::eddy_viscosity, &Flow::pressure})
      EXPECT_LT(difference(shared_run, single_run, field), 1e-6) << model;
  }
}

// From an impulsive start on tetrahedra k and epsilon, or omega, are positive everywhere without being raised, and the walls see a y+ of
// the log layer.
TEST(TurbulentDuct, positive) {
  for (const char* const model : models) {
    Duct run(MPI_COMM_WORLD, model);
    run.advance(20);
    EXPECT_EQ(run.raised, 0);
    for (int c = 0; c < run.mesh.n_cells; ++c) {
      EXPECT_GT(run.solver.flow.turbulent_kinetic_energy[c], 0);
      EXPECT_GT(run.solver.flow.dissipation_rate[c], 0);
    }
    const YPlus y_plus = y_plus_of(run.solver.flow, run.mesh.patch_index("y0"));
    EXPECT_GT(y_plus.lowest, 11.5) << model;
    EXPECT_LT(y_plus.lowest, y_plus.mean);
    EXPECT_LT(y_plus.mean, y_plus.highest);
    EXPECT_LT(y_plus.highest, 2e4);
  }
}

// A run resumed from a checkpoint gives the same bits as the uninterrupted one on the same ranks.
TEST(TurbulentDuct, resumed_run) {
  for (const char* const model : models) {
    Duct whole(MPI_COMM_WORLD, model), resumed(MPI_COMM_WORLD, model);
    whole.advance(4);
    take_over(whole.solver, resumed.solver, "turbulent_duct");
    whole.advance(5), resumed.advance(5);
    EXPECT_EQ(whole.solver.flow.velocity, resumed.solver.flow.velocity);
    EXPECT_EQ(whole.solver.flow.pressure, resumed.solver.flow.pressure);
    EXPECT_EQ(whole.solver.flow.turbulent_kinetic_energy, resumed.solver.flow.turbulent_kinetic_energy);
    EXPECT_EQ(whole.solver.flow.dissipation_rate, resumed.solver.flow.dissipation_rate);
    EXPECT_EQ(whole.solver.flow.face_viscosity, resumed.solver.flow.face_viscosity);
  }
}
