#include "observe/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace snag {

namespace {

/// Edges of one triangle only: the hem of the sheet.
std::vector<std::array<int, 2>> hem_of(std::span<const std::array<int, 3>> triangles) {
  std::vector<std::array<int, 2>> edges, hem;
  for (const auto& [a, b, c] : triangles)
    for (const auto& [from, to] : {std::array{a, b}, std::array{b, c}, std::array{c, a}})
      edges.push_back({std::min(from, to), std::max(from, to)});
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 0; e < edges.size(); ++e)
    if ((e == 0 || edges[e] != edges[e - 1]) && (e + 1 == edges.size() || edges[e] != edges[e + 1])) hem.push_back(edges[e]);
  return hem;
}

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
  for (int j = j0; j <= j1; ++j) {
    const double py = y0 + (j + 0.5) * side;
    for (int i = i0; i <= i1; ++i) {
      const double px = x0 + (i + 0.5) * side;
      bool inside = true;
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        inside = inside && (x[b] - x[a]) * (py - y[a]) - (y[b] - y[a]) * (px - x[a]) >= 0;
      }
      if (inside) covered[static_cast<std::size_t>(j) * nx + i] = 1;
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

void Coverage::fill_strip(const std::array<double, 2>& a, const std::array<double, 2>& b, double reach) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
  if (!(length > 0 && reach > 0)) return;
  const double across_x = -dy / length * reach, across_y = dx / length * reach;
  fill_triangle({a[0] + across_x, a[0] - across_x, b[0] - across_x}, {a[1] + across_y, a[1] - across_y, b[1] - across_y});
  fill_triangle({a[0] + across_x, b[0] - across_x, b[0] + across_x}, {a[1] + across_y, b[1] - across_y, b[1] + across_y});
}

void Coverage::fill_cloth(std::span<const std::array<double, 2>> place, std::span<const double> radius,
                          std::span<const std::array<int, 3>> triangles) {
  for (std::size_t k = 0; k < place.size(); ++k)
    if (radius[k] > 0) fill_circle(place[k][0], place[k][1], radius[k]);
  for (const auto& [a, b] : hem_of(triangles)) fill_strip(place[a], place[b], 0.5 * (radius[a] + radius[b]));
  for (const auto& [a, b, c] : triangles)
    if (!std::isnan(place[a][0] + place[b][0] + place[c][0]))
      fill_triangle({place[a][0], place[b][0], place[c][0]}, {place[a][1], place[b][1], place[c][1]});
}

double Coverage::area() const { return side * side * std::accumulate(covered.begin(), covered.end(), 0.0); }

}  // namespace snag
