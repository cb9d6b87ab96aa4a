#include "observe/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace snag {

namespace {

struct Pixels {
  double x0, y0, side;
  int nx, ny;
  std::vector<std::uint8_t> covered;

  void fill(std::array<double, 3> x, std::array<double, 3> y) {
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

  Silhouette moments() const {
    double m00 = 0, m10 = 0, m01 = 0, m20 = 0, m11 = 0, m02 = 0;
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        if (!covered[static_cast<std::size_t>(j) * nx + i]) continue;
        const double px = (i + 0.5) * side, py = (j + 0.5) * side;
        m00 += 1, m10 += px, m01 += py, m20 += px * px, m11 += px * py, m02 += py * py;
      }
    }
    Silhouette seen;
    if (m00 == 0) return seen;
    const double cx = m10 / m00, cy = m01 / m00;
    // A pixel is a square, not a point: its own second moment side^2/12 belongs to the blob.
    const double own = side * side / 12;
    const double xx = m20 / m00 - cx * cx + own, yy = m02 / m00 - cy * cy + own, xy = m11 / m00 - cx * cy;
    const double middle = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
    seen.area = m00 * side * side;
    seen.x = x0 + cx, seen.y = y0 + cy;
    seen.elongation_ratio = std::sqrt((middle + spread) / (middle - spread));
    seen.orientation = 0.5 * std::atan2(2 * xy, xx - yy);
    return seen;
  }
};

}  // namespace

Silhouette silhouette(std::span<const Vec3> points, std::span<const std::array<int, 3>> triangles, const View& view, double pixel) {
  constexpr double huge = std::numeric_limits<double>::max();
  double x_low = huge, x_high = -huge, y_low = huge, y_high = -huge;
  for (const auto& triangle : triangles) {
    for (const int node : triangle) {
      const double px = dot(points[node], view.right), py = dot(points[node], view.up);
      x_low = std::min(x_low, px), x_high = std::max(x_high, px), y_low = std::min(y_low, py), y_high = std::max(y_high, py);
    }
  }
  if (triangles.empty()) return {};
  Pixels pixels{x_low, y_low, pixel, static_cast<int>((x_high - x_low) / pixel) + 1, static_cast<int>((y_high - y_low) / pixel) + 1, {}};
  pixels.covered.resize(static_cast<std::size_t>(pixels.nx) * pixels.ny);
  for (const auto& triangle : triangles) {
    std::array<double, 3> x, y;
    for (int a = 0; a < 3; ++a) x[a] = dot(points[triangle[a]], view.right), y[a] = dot(points[triangle[a]], view.up);
    pixels.fill(x, y);
  }
  return pixels.moments();
}

}  // namespace snag
