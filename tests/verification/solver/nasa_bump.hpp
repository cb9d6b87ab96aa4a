#pragma once
// The bump in a channel of NASA's Turbulence Modeling Resource (2DB): a wall from x = 0 to 1.5, symmetry planes 25 before and 25 behind it
// and at y = 5, Re = 3e6 per length. Lengths in m, speed of the stream 1 m/s. The wall is at
//
//   y = 0.05 sin^4(pi x/0.9 - pi/3),   0.3 < x < 1.2,   else 0      (also
//   doc.openfoam.com/2212/examples/verification-validation/turbulent/bump-2d)
//
// NASA's codes are compressible, with M = 0.2.
#include "tests/verification/solver/nasa_cases.hpp"

namespace snag::test {

class NasaBump {
 public:
  static constexpr double reynolds = 3e6;

  static double height(double x) { return x < 0.3 || x > 1.2 ? 0 : 0.05 * std::pow(std::sin(pi * x / 0.9 - pi / 3), 4); }

  /// 3520 cells times m^2, as many over the length and the height of each part as NASA's grids of 1409 x 641 points and coarser; y+ of the
  /// first cells below 1 from m = 3 on.
  explicit NasaBump(int m) : mesh(grid(m)), solver(flow_solver(mesh)) {}

  std::vector<WallPlace> wall() const { return along_wall(solver.flow, "bump"); }

  Mesh mesh;
  FlowSolver solver;

 private:
  static Mesh grid(int m) {
    const int before = 14 * m, wall = 60 * m, across = 40 * m;
    constexpr double top = 5, length = 1.5;
    std::vector<double> x;
    append(x, -25, 0, graded(before, 1 / 1000.0)), append(x, 0, length, graded_to_both(wall, 3)),
        append(x, length, length + 25, graded(before, 1000));
    const std::vector<double> y = graded(across, 5e4);
    PlanarGrid plane{.n_i = 2 * before + wall, .n_j = across};
    plane.node = [=](int i, int j) {
      const double place = x[static_cast<std::size_t>(i)], low = height(place);
      return Vec3{place, low + (top - low) * y[static_cast<std::size_t>(j)], 0};
    };
    plane.patches = {"inlet", "outlet", "bump", "symmetry"};
    plane.patch = [=](int i, int, GridSide side) -> std::string {
      if (side == GridSide::low_i) return "inlet";
      if (side == GridSide::high_i) return "outlet";
      return side == GridSide::low_j && i >= before && i < before + wall ? "bump" : "symmetry";
    };
    return plane_mesh(plane);
  }

  static FlowSolver flow_solver(const Mesh& mesh) {
    // k = 9e-9 a^2 and omega = 1e-6 a^2/nu enter, a = U/0.2
    return nasa_solver(mesh, reynolds, 1, 1e-6, R"(
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity = ["1 m/s", "0 m/s", "0 m/s"]
turbulence_k = "2.25e-7 m2/s2"
turbulence_epsilon = "1.51875e-6 m2/s3"
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patch = "bump"
kind = "wall"
[[boundary]]
patches = ["symmetry", "sides"]
kind = "symmetry"
)");
  }
};

}  // namespace snag::test
