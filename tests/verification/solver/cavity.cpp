// ranks: 1
// long ranks: 2
// timeout: 600
// cost: 15
#include <gtest/gtest.h>

#include "tests/verification/solver/flow_cases.hpp"

using namespace snag;
using namespace snag::test;

namespace {

constexpr double centre = 0.5 + 1e-9;  // just off the faces between the two middle cells

// Ghia, Ghia and Shin (1982), Tables I and II, Re = 1000, 129 x 129: u along the vertical, v along the horizontal centre line.
struct Point {
  double at, value;
};
constexpr Point u_of_height[] = {{0.0547, -0.18109}, {0.0625, -0.20196}, {0.0703, -0.22220}, {0.1016, -0.29730}, {0.1719, -0.38289},
                                 {0.2813, -0.27805}, {0.4531, -0.10648}, {0.5000, -0.06080}, {0.6172, 0.05702},  {0.7344, 0.18719},
                                 {0.8516, 0.33304},  {0.9531, 0.46604},  {0.9609, 0.51117},  {0.9688, 0.57492},  {0.9766, 0.65928}};
constexpr Point v_along[] = {{0.0625, 0.27485},  {0.0703, 0.29012},  {0.0781, 0.30353},  {0.0938, 0.32627},  {0.1563, 0.37095},
                             {0.2266, 0.33075},  {0.2344, 0.32235},  {0.5000, 0.02526},  {0.8047, -0.31966}, {0.8594, -0.42665},
                             {0.9063, -0.51550}, {0.9453, -0.39188}, {0.9531, -0.33714}, {0.9609, -0.27669}, {0.9688, -0.21388}};

/// A component of velocity at a point of the x-z plane, from the gradient of the cell that holds it; summed over ranks.
double sample(const Flow& flow, double h, Vec3 x, int component) {
  double value = 0;
  for (int c = 0; c < flow.mesh.n_cells; ++c) {
    const Vec3 way = x - flow.mesh.cell_centre[c];
    // Half-open cells: a point on a face belongs to one of them.
    if (way.x > 0.5 * h || way.x <= -0.5 * h || way.z > 0.5 * h || way.z <= -0.5 * h) continue;
    value += flow.velocity[c][component] + dot(flow.velocity_gradient[c][component], {way.x, 0, way.z});
  }
  return sum(flow.mesh.comm, value);
}

}  // namespace

// The lid-driven cavity at Re 1000 on 80 x 80 cells agrees with Ghia, Ghia and Shin to 1.5 % of the lid's speed.
TEST(Cavity, ghia_re_1000) {
  const int n = 80;
  const double h = 1.0 / n;
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, h, 1}, {n, 1, n});
  FlowSettings settings;
  settings.density = 1, settings.kinematic_viscosity = 1e-3;
  FlowSolver solver(mesh, settings, conditions(R"(
[[boundary]]
patches = ["x0", "x1", "z0"]
kind = "wall"
[[boundary]]
patches = ["y0", "y1"]
kind = "symmetry"
[[boundary]]
patch = "z1"
kind = "moving_wall"
velocity = ["1 m/s", "0 m/s", "0 m/s"]
)"));
  double change = 1;
  for (int i = 0; i < 3000 && change > 4e-6; ++i) {
    solver.advance(0.06);
    change = distance(mesh, [&](int c) { return norm_squared(solver.flow.velocity[c] - solver.flow.velocity_old[c]); });
  }
  EXPECT_LE(change, 4e-6) << "the cavity must be steady for the comparison";
  double worst = 0;
  for (const Point& p : u_of_height) worst = std::max(worst, std::abs(sample(solver.flow, h, {centre, 0.5 * h, p.at + 1e-9}, 0) - p.value));
  for (const Point& p : v_along) worst = std::max(worst, std::abs(sample(solver.flow, h, {p.at + 1e-9, 0.5 * h, centre}, 2) - p.value));
  if (rank_of(mesh.comm) == 0)
    std::printf("largest difference from Ghia et al.: %.4f of the lid's speed, t = %.1f\n", worst, solver.flow.time);
  EXPECT_LT(worst, 0.015);
}
