#include "observe/coverage.hpp"

#include <algorithm>
#include <numeric>

namespace snag {

namespace {

/// The side of the edge from a to b on which the points of a triangle that turns left lie, or the edge itself where it is one at the left
/// or at the bottom. The product is formed from the same end whichever way the edge runs: both triangles at it then decide by one number,
/// so that round-off leaves no gap between them.
struct Edge {
  double x, y, dx, dy, sign;
  bool has_own_points;

  Edge(double ax, double ay, double bx, double by) {
    const bool runs_on = ax < bx || (ax == bx && ay < by);
    x = runs_on ? ax : bx, y = runs_on ? ay : by;
    dx = (runs_on ? bx : ax) - x, dy = (runs_on ? by : ay) - y;
    sign = runs_on ? 1 : -1;
    has_own_points = by < ay || (by == ay && bx > ax);
  }
  bool holds(double px, double py) const {
    const double left = sign * (dx * (py - y) - dy * (px - x));
    return left > 0 || (left == 0 && has_own_points);
  }
};

}  // namespace

Coverage::Coverage(double x_low, double y_low, double x_high, double y_high, double pixel)
    : x0(x_low),
      y0(y_low),
      side(pixel),
      nx(static_cast<int>((x_high - x_low) / pixel) + 1),
      ny(static_cast<int>((y_high - y_low) / pixel) + 1),
      covered(static_cast<std::size_t>(nx) * ny) {}

void Coverage::fill_triangle(std::array<double, 3> x, std::array<double, 3> y) {
  const double twice_area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (twice_area < 0) std::swap(x[1], x[2]), std::swap(y[1], y[2]);
  const auto [x_low, x_high] = std::minmax({x[0], x[1], x[2]});
  const auto [y_low, y_high] = std::minmax({y[0], y[1], y[2]});
  const int i0 = std::max(0, static_cast<int>((x_low - x0) / side - 0.5)), i1 = std::min(nx - 1, static_cast<int>((x_high - x0) / side));
  const int j0 = std::max(0, static_cast<int>((y_low - y0) / side - 0.5)), j1 = std::min(ny - 1, static_cast<int>((y_high - y0) / side));
  const std::array edges{Edge(x[0], y[0], x[1], y[1]), Edge(x[1], y[1], x[2], y[2]), Edge(x[2], y[2], x[0], y[0])};
  for (int j = j0; j <= j1; ++j) {
    const double py = y0 + (j + 0.5) * side;
    for (int i = i0; i <= i1; ++i) {
      const double px = x0 + (i + 0.5) * side;
      if (edges[0].holds(px, py) && edges[1].holds(px, py) && edges[2].holds(px, py)) covered[static_cast<std::size_t>(j) * nx + i] = 1;
    }
  }
}

void Coverage::fill_circle(double x, double y, double radius) {
  const int i0 = std::max(0, static_cast<int>((x - radius - x0) / side - 0.5)),
            i1 = std::min(nx - 1, static_cast<int>((x + radius - x0) / side));
  const int j0 = std::max(0, static_cast<int>((y - radius - y0) / side - 0.5)),
            j1 = std::min(ny - 1, static_cast<int>((y + radius - y0) / side));
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const double dx = x0 + (i + 0.5) * side - x, dy = y0 + (j + 0.5) * side - y;
      if (dx * dx + dy * dy <= radius * radius) covered[static_cast<std::size_t>(j) * nx + i] = 1;
    }
}

double Coverage::area() const { return side * side * std::accumulate(covered.begin(), covered.end(), 0.0); }

}  // namespace snag
