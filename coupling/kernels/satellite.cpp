// Satellite points: 33 points of equal weight stand for a ball of the radius R = 5^(1/2) delta, each counts in the cell that holds it.
//
//   1 point at the centre, 12 at the corners of an icosahedron, 20 at those of a dodecahedron around it
//
// The ball is cut into a core and two layers whose volumes are as their numbers of points; r_k^2 is the mean of r^2 in its layer,
// 3/5 (b^5 - a^5)/(b^3 - a^3) from a to b, and all are scaled so that the rms width per axis is delta. Corners of these bodies spread as a
// sphere does up to the fifth moment. They are turned out of the axes, so that few points lie on the faces of a regular mesh.
//
// Neighbouring points are 0.7 to 1.1 delta apart: where cells are smaller, cells between the points get nothing. The average then holds
// more of what the particle itself does to the water. On cells of side h, each of which acts as a Gaussian of width s = 0.25 h,
//
//   1/delta_h = pi^(1/2)/33^2 sum_jk erf(r_jk/(2 s))/r_jk,     1/(pi^(1/2) s) for j = k
//
// is the inverse width of the Gaussian that holds as much (coupling/forces/self_disturbance.cpp): delta_h is 1.05 delta for h = delta,
// 0.93 delta for h = delta/2, 0.55 delta for h = delta/8. What it is above that of the ball is felt in cells alone, where water is viscous.
//
// In the manner of CFDEMcoupling (dividedVoidFraction: centre and two shells of 14 points), known as the satellite point method.
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "coupling/point_kernel.hpp"

namespace snag {
namespace {

constexpr int n_inner = 12, n_outer = 20, n_points = 1 + n_inner + n_outer;

/// Corners of an icosahedron, then of a dodecahedron, on the unit sphere.
std::vector<Vec3> corners() {
  constexpr double golden = std::numbers::phi;
  std::vector<Vec3> all;
  const auto add_cyclic = [&](double a, double b) {  // (0, +-a, +-b) and its cyclic permutations
    for (const double p : {-a, a})
      for (const double q : {-b, b})
        for (int axis = 0; axis < 3; ++axis) {
          Vec3& x = all.emplace_back();
          x[(axis + 1) % 3] = p, x[(axis + 2) % 3] = q;
        }
  };
  add_cyclic(1, golden);
  add_cyclic(1 / golden, golden);
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) all.push_back({x, y, z});
  const Mat3 turn = rotation(unit({1, 2, 3}), 1);
  for (Vec3& x : all) x = turn * unit(x);
  return all;
}

/// At delta = 1.
const std::vector<Vec3>& unit_points() {
  static const std::vector<Vec3> points = [] {
    const auto mean_square = [](double before, double behind) {  // of r in the layer between these shares of the ball, R = 1
      const double a = std::cbrt(before), b = std::cbrt(behind);
      return 0.6 * (std::pow(b, 5) - std::pow(a, 5)) / (behind - before);
    };
    constexpr double n = n_points;
    const double inner = mean_square(1 / n, (1 + n_inner) / n), outer = mean_square((1 + n_inner) / n, 1);
    const double scale = std::sqrt(3 * n / (n_inner * inner + n_outer * outer));
    std::vector<Vec3> all{{}};
    for (const Vec3& x : corners()) all.push_back(scale * std::sqrt(all.size() <= n_inner ? inner : outer) * x);
    return all;
  }();
  return points;
}

/// Distances of two different points at delta = 1 and how often each occurs among the ordered pairs.
const std::map<double, int>& pair_distances() {
  static const std::map<double, int> distances = [] {
    std::map<double, int> found;
    for (const Vec3& a : unit_points())
      for (const Vec3& b : unit_points())
        if (&a != &b) ++found[std::round(norm(a - b) * 1e9) * 1e-9];  // equal ones differ by round-off
    return found;
  }();
  return distances;
}

struct SatelliteKernel final : PointKernel {
  static constexpr const char* name = "satellite";
  std::string equation() const override { return "33 points of equal weight in a ball of radius 5^(1/2) delta, each in its cell"; }
  std::string source() const override { return "satellite point method, in the manner of CFDEMcoupling's dividedVoidFraction"; }
  /// Of the ball: <1/|x - x'|> = 6/(5 R).
  double overlap() const override { return std::sqrt(std::numbers::pi) * 6 / (5 * std::sqrt(5.0)); }
  double largest_width_over_cell() const override { return 2.5; }
  double point_disturbance(double width, double side) const override {
    const double s = width_of_cell(side) / width;
    double sum = n_points / (std::sqrt(std::numbers::pi) * s);
    for (const auto& [r, n] : pair_distances()) sum += n * std::erf(r / (2 * s)) / r;
    return std::sqrt(std::numbers::pi) * sum / (n_points * n_points * width) - 1 / disturbance_width(width, side);
  }
  std::vector<Vec3> points(double width) const override {
    std::vector<Vec3> all = unit_points();
    for (Vec3& x : all) x *= width;
    return all;
  }
};
[[maybe_unused]] const bool registered = kernel_shapes().add<SatelliteKernel>();

}  // namespace
}  // namespace snag
