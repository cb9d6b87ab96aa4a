// ranks: 1
// timeout: 900
// cost: 60
#include <gtest/gtest.h>

#include "solver/monitors.hpp"
#include "tests/verification/solver/flow_cases.hpp"
#include "tests/verification/solver/planar_grid.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double speed = 1, length = 1, Re = 5e6, nu = speed * length / Re;  // m/s, m, 1, m2/s

/// Places of the lines along the plate: n_before cells up to its leading edge, then n_plate cells over 2 m, all the finer the nearer to it.
std::vector<double> lines_along(int n_before, int n_plate) {
  constexpr double upstream = 1.0 / 3;
  std::vector<double> x;
  for (const double place : graded(n_before, 40)) x.push_back(-upstream * place);
  std::reverse(x.begin(), x.end());
  for (const double place : graded(n_plate, 20))
    if (place > 0) x.push_back(2 * place);
  return x;
}

/// The plate of NASA's Turbulence Modeling Resource (2DZP): from x = 0 to 2, symmetry before it, 1 m of water above it.
Mesh plate_mesh(int n_before, int n_plate, int n_across, double first_thickness) {
  double ratio = 1, upper = 1e9;
  for (int i = 0; i < 200; ++i) {  // ratio of the last to the first thickness by bisection of its logarithm
    const double middle = std::sqrt(ratio * upper);
    (graded(n_across, middle)[1] > first_thickness ? ratio : upper) = middle;
  }
  const std::vector<double> x = lines_along(n_before, n_plate), y = graded(n_across, ratio);
  PlanarGrid grid{.n_i = n_before + n_plate, .n_j = n_across, .depth = 0.01};
  grid.node = [=](int i, int j) { return Vec3{x[static_cast<std::size_t>(i)], y[static_cast<std::size_t>(j)], 0}; };
  grid.patches = {"inlet", "outlet", "plate", "before", "top"};
  grid.patch = [=](int i, int, GridSide side) -> std::string {
    switch (side) {
      case GridSide::low_i:
        return "inlet";
      case GridSide::high_i:
        return "outlet";
      case GridSide::low_j:
        return i < n_before ? "before" : "plate";
      default:
        return "top";
    }
  };
  return plane_mesh(grid);
}

/// Friction coefficient of the plate at a place, between the faces.
double friction_at(const Flow& flow, double x) {
  const Mesh& mesh = flow.mesh;
  const Patch& plate = mesh.patches[static_cast<std::size_t>(mesh.patch_index("plate"))];
  std::vector<std::pair<double, double>> found;
  for (int f = plate.first; f < plate.end(); ++f)
    found.emplace_back(mesh.face_centre[f].x,
                       flow.boundary_friction[f - mesh.n_interior].x / norm(mesh.face_vector[f]) / (0.5 * flow.density * speed * speed));
  std::sort(found.begin(), found.end());
  std::size_t i = 1;
  while (i + 1 < found.size() && found[i].first < x) ++i;
  const double share = (x - found[i - 1].first) / (found[i].first - found[i - 1].first);
  return found[i - 1].second + share * (found[i].second - found[i - 1].second);
}

/// Friction coefficient at x = 0.97, a mean over the last steps.
double settled_friction(const Mesh& mesh) {
  FlowSettings settings;
  settings.kinematic_viscosity = nu, settings.initial_velocity = {speed, 0, 0}, settings.momentum_tolerance = 1e-6;
  const auto boundary = R"(
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity = ["1 m/s", "0 m/s", "0 m/s"]
turbulence_k = "2.25e-7 m2/s2"
turbulence_epsilon = "2.53e-6 m2/s3"
[[boundary]]
patches = ["outlet", "top"]
kind = "pressure_outlet"
turbulence_k = "2.25e-7 m2/s2"
turbulence_epsilon = "2.53e-6 m2/s3"
[[boundary]]
patch = "plate"
kind = "wall"
[[boundary]]
patches = ["before", "sides"]
kind = "symmetry"
)";
  FlowSolver solver(mesh, settings, conditions(boundary),
                    read_turbulence(CaseFile::parse("[turbulence]\nmodel = \"k_omega_sst\"\ntolerance = 1e-6\ninitial_k = \"1e-3 m2/s2\"\n"
                                                    "initial_epsilon = \"1e-3 m2/s3\"\n")
                                        .root()));
  constexpr int n_steps = 250, n_counted = 100;  // the friction wanders by 0.4 % about its mean
  double friction = 0;
  for (int step = 0; step < n_steps; ++step) {
    solver.advance(0.05);
    if (step >= n_steps - n_counted) friction += friction_at(solver.flow, 0.97) / n_counted;
  }
  const YPlus y_plus = y_plus_of(solver.flow, mesh.patch_index("plate"));
  std::printf("%d cells: c_f at x = 0.97 %.6f, mean y+ %.2f\n", mesh.n_cells, friction, y_plus.mean);
  return friction;
}

}  // namespace

// Friction of a flat plate at Re_x 4.85e6 is that of NASA's CFL3D with the SST model on its finest grid, 0.0026909, within 2 % with first
// cells at y+ 0.4, and within 5 % with those at y+ 5, 30 and 100.
TEST(FlatPlate, friction) {
  constexpr double by_nasa = 0.0026909, y_plus_one = 5.45e-6;  // 1, m
  EXPECT_NEAR(settled_friction(plate_mesh(24, 112, 96, 2 * 0.4 * y_plus_one)) / by_nasa, 1, 0.02);
  for (const double y_plus : {5.0, 30.0, 100.0})
    EXPECT_NEAR(settled_friction(plate_mesh(24, 112, y_plus < 10 ? 72 : 56, 2 * y_plus * y_plus_one)) / by_nasa, 1, 0.05);
}
