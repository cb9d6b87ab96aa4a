#pragma once
// The backward-facing step of Driver and Seegmiller (1985), AIAA J. 23, 163-171, as NASA's Turbulence Modeling Resource sets it for the SST
// model: a channel 8 H high opens to 9 H at x = 0, walls from x = -110 H on behind a symmetry plane of 20 H, Re_H = 36000 with the speed at
// x = -4 H in the middle of the channel. H = 1 m here, that speed 1 m/s.
#include "tests/verification/solver/nasa_cases.hpp"

namespace snag::test {

class NasaStep {
 public:
  static constexpr double reynolds = 36000, entering = 0.947;

  /// 2349 cells times m^2, first cells below y+ 1 from m = 2 on.
  explicit NasaStep(int m) : mesh(grid(m)), solver(flow_solver(mesh)) {}

  /// At x = -4 H in the middle of the channel, m/s.
  double reference_speed() const { return speed_at(solver.flow, -4, 5); }
  std::vector<WallPlace> floor() const { return along_wall(solver.flow, "floor", reference_speed()); }
  std::vector<WallPlace> upstream() const { return along_wall(solver.flow, "upstream", reference_speed()); }
  /// Friction of the floor and of the wall before it.
  double friction(double x) const { return at(x < 0 ? upstream() : floor(), &WallPlace::friction, x); }
  /// c_p of the floor less that at x = 37.5, where the measured one is shifted to zero.
  double pressure(double x) const { return at(floor(), &WallPlace::pressure, x) - at(floor(), &WallPlace::pressure, 37.5); }

  Mesh mesh;
  FlowSolver solver;

 private:
  static Mesh grid(int m) {
    const int before = 2 * m, plate = 26 * m, below = 16 * m, above = 24 * m;
    std::vector<double> x, y;
    append(x, -130, -110, graded(before, 1 / 8.0)), append(x, -110, -55, graded(6 * m, 6)), append(x, -55, 0, graded(20 * m, 1 / 150.0));
    append(x, 0, 20, graded(36 * m, 25)), append(x, 20, 50, graded(6 * m, 6));
    append(y, 0, 1, graded_to_both(below, 150)), append(y, 1, 9, graded_to_both(above, 1000));
    PlanarGrid plane{.n_i = static_cast<int>(x.size()) - 1, .n_j = static_cast<int>(y.size()) - 1};
    plane.node = [x, y](int i, int j) { return Vec3{x[static_cast<std::size_t>(i)], y[static_cast<std::size_t>(j)], 0}; };
    plane.filled = [=](int i, int j) { return i >= before + plate || j >= below; };
    plane.patches = {"inlet", "outlet", "before", "upstream", "face", "floor", "top"};
    plane.patch = [=](int i, int j, GridSide side) -> std::string {
      if (side == GridSide::low_i) return i == 0 ? "inlet" : "face";
      if (side == GridSide::high_i) return "outlet";
      if (i < before) return "before";
      return side == GridSide::high_j ? "top" : j == 0 ? "floor" : "upstream";
    };
    return plane_mesh(plane);
  }

  static FlowSolver flow_solver(const Mesh& mesh) {
    // k = 9e-9 a^2 and omega = 1e-6 a^2/nu enter, a = U/0.128
    return nasa_solver(mesh, reynolds, entering, 1e-4, R"(
initial_k = "1e-3 m2/s2"
initial_epsilon = "1e-4 m2/s3"
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity = ["0.947 m/s", "0 m/s", "0 m/s"]
turbulence_k = "5.49e-7 m2/s2"
turbulence_epsilon = "1.086e-7 m2/s3"
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = ["upstream", "face", "floor", "top"]
kind = "wall"
[[boundary]]
patches = ["before", "sides"]
kind = "symmetry"
)");
  }
};

}  // namespace snag::test
