#pragma once
// A picture of what covers what: square pixels that are covered or not, from a camera far away or from a photograph.
#include <array>
#include <cstdint>
#include <vector>

namespace snag {

/// Pixel (i, j) has its centre at (x0 + (i + 1/2) side, y0 + (j + 1/2) side); rows go up.
struct Coverage {
  double x0 = 0, y0 = 0, side = 0;  // m
  int nx = 0, ny = 0;
  std::vector<std::uint8_t> covered;  // [ny * nx] 1 or 0

  /// An empty picture that holds the rectangle.
  Coverage(double x_low, double y_low, double x_high, double y_high, double pixel);

  bool at(int i, int j) const { return i >= 0 && j >= 0 && i < nx && j < ny && covered[static_cast<std::size_t>(j) * nx + i] != 0; }
  /// Covers the pixels whose centres are in the triangle. Of two triangles on either side of a common edge one has the centres on it; an
  /// edge that is not shared has them at the left and at the bottom.
  void fill_triangle(std::array<double, 3> x, std::array<double, 3> y);
  /// Covers the pixels whose centres are in the circle.
  void fill_circle(double x, double y, double radius);
  /// Covered area, m2.
  double area() const;
};

}  // namespace snag
