// ranks: 1 2 3
// long ranks: 5
#include <gtest/gtest.h>

#include <map>

#include "tests/verification/solver/flow_cases.hpp"
#include "tests/verification/solver/take_over.hpp"

using namespace snag;
using namespace snag::test;

namespace {

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
[[boundary]]
patch = "x1"
kind = "pressure_outlet"
)";

struct Duct {
  Mesh mesh;
  FlowSolver solver;
  explicit Duct(MPI_Comm comm, bool sharp = true)
      : mesh(tetrahedral_box(comm, {.upper = {2, 1, 1}, .distortion = 0.15}, {8, 4, 5})), solver(mesh, settings(sharp), conditions(duct)) {}
  static FlowSettings settings(bool sharp) {
    FlowSettings chosen = sharp_settings();
    if (!sharp) chosen.momentum_tolerance = 1e-8, chosen.pressure_tolerance = 1e-6, chosen.pressure_tolerance_intermediate = 1e-2;
    chosen.kinematic_viscosity = 0.005;
    return chosen;
  }
  void advance(int steps) {
    solver.flow.reaction.resize(static_cast<std::size_t>(mesh.n_cells));
    for (int i = 0; i < steps; ++i) {
      for (int c = 0; c < mesh.n_cells; ++c)
        solver.flow.reaction[c] = norm(mesh.cell_centre[c] - Vec3{1, 0.5, 0.5}) < 0.3 ? Vec3{-60, 0, 5} : Vec3{};
      solver.advance(0.03);
    }
  }
};

}  // namespace

// Fields after 50 steps on several ranks are those of one rank within 1e-6 (here 1e-8).
TEST(RankIndependence, fifty_steps) {
  Duct shared_run(MPI_COMM_WORLD), single_run(MPI_COMM_SELF);
  shared_run.advance(50), single_run.advance(50);
  std::map<std::int64_t, int> cell_of_id;
  for (int c = 0; c < single_run.mesh.n_cells; ++c) cell_of_id[single_run.mesh.cell_id[c]] = c;
  double velocity = 0, pressure = 0, speed = 0, largest_pressure = 0;
  for (int c = 0; c < shared_run.mesh.n_cells; ++c) {
    const int same = cell_of_id.at(shared_run.mesh.cell_id[c]);
    velocity = std::max(velocity, norm(shared_run.solver.flow.velocity[c] - single_run.solver.flow.velocity[same]));
    pressure = std::max(pressure, std::abs(shared_run.solver.flow.pressure[c] - single_run.solver.flow.pressure[same]));
    speed = std::max(speed, norm(single_run.solver.flow.velocity[same]));
    largest_pressure = std::max(largest_pressure, std::abs(single_run.solver.flow.pressure[same]));
  }
  EXPECT_LE(velocity, 1e-8 * maximum(MPI_COMM_WORLD, speed));
  EXPECT_LE(pressure, 1e-8 * maximum(MPI_COMM_WORLD, largest_pressure));
}

// A run repeated on the same ranks gives the same bits.
TEST(RankIndependence, repeated_run) {
  Duct first(MPI_COMM_WORLD, false), second(MPI_COMM_WORLD, false);
  first.advance(10), second.advance(10);
  EXPECT_EQ(first.solver.flow.velocity, second.solver.flow.velocity);
  EXPECT_EQ(first.solver.flow.pressure, second.solver.flow.pressure);
  EXPECT_EQ(first.solver.flow.flux, second.solver.flow.flux);
}

// A run resumed from a checkpoint gives the same bits as the uninterrupted one on the same ranks.
TEST(RankIndependence, resumed_run) {
  Duct whole(MPI_COMM_WORLD, false), resumed(MPI_COMM_WORLD, false);
  whole.advance(7);
  take_over(whole.solver, resumed.solver, "rank_independence");
  whole.advance(8), resumed.advance(8);
  EXPECT_EQ(whole.solver.flow.velocity, resumed.solver.flow.velocity);
  EXPECT_EQ(whole.solver.flow.pressure, resumed.solver.flow.pressure);
  EXPECT_EQ(whole.solver.flow.flux, resumed.solver.flow.flux);
  EXPECT_EQ(whole.solver.flow.time, resumed.solver.flow.time);
}
