#pragma once
// A picture of what covers what: square pixels that are covered or not, from a camera far away or from a photograph.
#include <array>
#include <cstdint>
#include <span>
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
  /// Covers the pixels whose centres are in the triangle.
  void fill_triangle(std::array<double, 3> x, std::array<double, 3> y);
  /// Covers the pixels whose centres are in the circle.
  void fill_circle(double x, double y, double radius);
  /// Covers what cloth does: triangles between the places of its particles (indices into `place`) and a disc of `radius` around each,
  /// joined along the hem, so that it is as large as the cloth. A place that is not a number is left out, with what is at it.
  void fill_cloth(std::span<const std::array<double, 2>> place, std::span<const double> radius,
                  std::span<const std::array<int, 3>> triangles);
  /// Covered area, m2.
  double area() const;

 private:
  /// A strip of half width `reach` along the line from a to b.
  void fill_strip(const std::array<double, 2>& a, const std::array<double, 2>& b, double reach);
};

}  // namespace snag
