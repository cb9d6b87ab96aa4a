#pragma once
// The flat plate of NASA's Turbulence Modeling Resource (2DZP): from x = 0 to 2, symmetry before it from x = -1/3, the stream 1 above it,
// Re = 5e6 per length. Lengths in m, speed of the stream 1 m/s.
#include "tests/verification/solver/nasa_cases.hpp"

namespace snag::test {

class NasaPlate {
 public:
  static constexpr double reynolds = 5e6, wall_unit = 5.45e-6;  // y at y+ = 1 where x = 0.97, m

  /// 34 m x 24 m cells, as many as NASA's grids of 545 x 385 points (m = 16) and coarser; the first cells at this y+ in the middle of the
  /// plate.
  explicit NasaPlate(int m, double y_plus) : NasaPlate(m, 24 * m, y_plus) {}
  NasaPlate(int m, int n_across, double y_plus) : mesh(grid(m, n_across, 2 * y_plus * wall_unit)), solver(flow_solver(mesh)) {}

  std::vector<WallPlace> wall() const { return along_wall(solver.flow, "plate"); }
  double friction(double x) const { return at(wall(), &WallPlace::friction, x); }
  /// Drag over rho U^2/2 and the area of the plate.
  double drag() const { return patch_force(solver.flow, mesh.patch_index("plate"), {}).friction.x / (0.5 * 2 * depth); }

  Mesh mesh;
  FlowSolver solver;

 private:
  static constexpr double depth = 0.01;

  static Mesh grid(int m, int n_across, double first_thickness) {
    double ratio = 1, upper = 1e9;
    for (int i = 0; i < 200; ++i) {  // ratio of the last to the first thickness by bisection of its logarithm
      const double middle = std::sqrt(ratio * upper);
      (graded(n_across, middle)[1] > first_thickness ? ratio : upper) = middle;
    }
    const int before = 6 * m;
    std::vector<double> x;
    append(x, -1.0 / 3, 0, graded(before, 1 / 40.0)), append(x, 0, 2, graded(28 * m, 20));
    const std::vector<double> y = graded(n_across, ratio);
    PlanarGrid plane{.n_i = static_cast<int>(x.size()) - 1, .n_j = n_across, .depth = depth};
    plane.node = [=](int i, int j) { return Vec3{x[static_cast<std::size_t>(i)], y[static_cast<std::size_t>(j)], 0}; };
    plane.patches = {"inlet", "outlet", "plate", "before", "top"};
    plane.patch = [=](int i, int, GridSide side) -> std::string {
      switch (side) {
        case GridSide::low_i:
          return "inlet";
        case GridSide::high_i:
          return "outlet";
        case GridSide::low_j:
          return i < before ? "before" : "plate";
        default:
          return "top";
      }
    };
    return plane_mesh(plane);
  }

  static FlowSolver flow_solver(const Mesh& mesh) {
    return nasa_solver(mesh, reynolds, 1, FlowSettings{}.pressure_tolerance, R"(
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
)");
  }
};

}  // namespace snag::test
