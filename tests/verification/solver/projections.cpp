// ranks: 1 3
// Projections on ordinary tetrahedra.
#include <gtest/gtest.h>

#include <cstdlib>

#include "mesh/import/import.hpp"
#include "solver/continuity.hpp"
#include "solver/operators/workspace.hpp"
#include "tests/sources.hpp"
#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

Mesh coarse_pump() { return import_mesh(in_sources("cases/meshes/pump_coarse.msh"), MPI_COMM_WORLD); }

}  // namespace

// Water at rest that enters and leaves everywhere with the same velocity has it in all cells when it is started.
TEST(Projections, start_is_uniform_where_the_boundary_is) {
  const Mesh mesh = coarse_pump();
  const Vec3 U{1, -2, 0.5};
  FlowSolver solver(mesh, {}, conditions(R"(
[[boundary]]
patches = ["inlet", "outlet", "impeller_walls", "casing_walls", "interface_rotor", "interface_stator"]
kind = "velocity_inlet"
velocity_m_s = [1, -2, 0.5]
)"));
  solver.initialise(0);
  const double lacks = distance(mesh, [&](int c) { return norm_squared(solver.flow.velocity[c] - U); }) / norm(U);
  std::printf("rms of what the start lacks of a uniform flow: %.2f %%\n", 100 * lacks);
  EXPECT_LT(lacks, 0.08);
}

// Velocities differ from cell to cell without a pattern. In small steps the pressure removes the divergence of their fluxes in every step,
// while convection and friction hardly smooth them. In the impeller and the casing of a pump, closed by walls, they must not grow: from the
// 40th to the 80th projection the rms rises by at most 2 %. With the gradient of each cell itself, every projection raised it by a quarter.
TEST(Projections, velocities_without_pattern_do_not_grow_on_tetrahedra) {
  const Mesh mesh = coarse_pump();
  BoundarySet boundary(mesh, conditions(R"(
[[boundary]]
patches = ["inlet", "outlet", "impeller_walls", "casing_walls", "interface_rotor", "interface_stator"]
kind = "wall"
)"));
  Flow flow(mesh);
  flow.density = 1;
  Workspace workspace(mesh);
  const LeastSquares squares(mesh, workspace.moments, boundary.velocity_sides());
  Continuity continuity(mesh, boundary, {.tolerance = 1e-6, .tolerance_intermediate = 1e-3}, workspace);
  const auto rms = [&] { return distance(mesh, [&](int c) { return norm_squared(flow.velocity[c]); }); };

  boundary.update(flow, 0);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3 x = 1e5 * mesh.cell_centre[c];
    flow.velocity[c] = {std::sin(7 * x.x + 3 * x.y), std::sin(5 * x.y + 2 * x.z), std::sin(11 * x.z + 4 * x.x)};
  }
  std::vector<Mat3> gradient(flow.velocity.size());
  double after_40 = 0;
  for (int k = 1; k <= 80; ++k) {
    mesh.halo.exchange(flow.velocity);
    squares.gradient(flow.velocity, boundary.values().velocity, gradient);
    continuity.project(flow, boundary, gradient, 1);
    if (k == 40) after_40 = rms();
  }
  std::printf("rms after 40 projections %.4f, after 80 %.4f m/s\n", after_40, rms());
  EXPECT_GT(after_40, 0.1);
  EXPECT_LT(rms(), 1.02 * after_40);
}
