#include "observe/silhouette.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace snag;

namespace {

struct Sheet {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
};

// An ellipse with half axes a and b as a fan, turned by `angle` in the plane of the picture.
Sheet ellipse(double a, double b, double angle, int n = 720) {
  Sheet sheet;
  sheet.points.push_back({0.3, -0.2, 7});
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i / n, x = a * std::cos(t), y = b * std::sin(t);
    sheet.points.push_back(sheet.points[0] +
                           Vec3{x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle), 0.1 * x});
    sheet.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  return sheet;
}

std::vector<double> no_rim(const Sheet& sheet) { return std::vector<double>(sheet.points.size(), 0); }

}  // namespace

// A square along the axes of the picture, in cells of four pixels whose diagonals run through the centres of pixels: its area is that of
// the pixels, wherever it lies.
TEST(Silhouette, SquareAlongTheAxes) {
  constexpr int n = 30;
  for (const double place : {0.0, 0.05, 0.08, 0.0137, 0.3}) {
    Sheet square;
    for (int row = 0; row <= n; ++row)
      for (int column = 0; column <= n; ++column) square.points.push_back({place - 0.03 + 2e-3 * column, place - 0.03 + 2e-3 * row, 0});
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const int a = (n + 1) * row + column;
        square.triangles.push_back({a, a + 1, a + n + 2}), square.triangles.push_back({a, a + n + 2, a + n + 1});
      }
    const Silhouette seen = silhouette(square.points, no_rim(square), square.triangles, {}, 5e-4);
    EXPECT_NEAR(seen.area, 0.06 * 0.06, 1e-9) << place;
    EXPECT_NEAR(seen.elongation_ratio, 1, 1e-9) << place;
  }
}

// An ellipse of known moments is measured to 0.5 %.
TEST(Silhouette, EllipseToHalfAPercent) {
  for (const double angle : {0.0, 0.4, -1.2}) {
    const Sheet sheet = ellipse(0.15, 0.05, angle);
    const Silhouette seen = silhouette(sheet.points, no_rim(sheet), sheet.triangles, {}, 5e-4);
    EXPECT_NEAR(seen.area, std::numbers::pi * 0.15 * 0.05, 0.005 * std::numbers::pi * 0.15 * 0.05);
    EXPECT_NEAR(seen.elongation_ratio, 3, 0.015);
    EXPECT_NEAR(seen.orientation, angle, 0.005);
    EXPECT_NEAR(seen.x, 0.3, 1e-4);
    EXPECT_NEAR(seen.y, -0.2, 1e-4);
  }
}

// What covers itself counts once, and the view decides what is seen: a sheet seen from its edge has no area to speak of.
TEST(Silhouette, OverlapAndView) {
  Sheet sheet = ellipse(0.1, 0.1, 0);
  const double once = silhouette(sheet.points, no_rim(sheet), sheet.triangles, {}, 1e-3).area;
  const int n = static_cast<int>(sheet.points.size());
  for (int i = 0; i < n; ++i) sheet.points.push_back(sheet.points[i] + Vec3{0, 0, 1});
  for (std::size_t i = 0, count = sheet.triangles.size(); i < count; ++i) {
    const auto [a, b, c] = sheet.triangles[i];
    sheet.triangles.push_back({a + n, c + n, b + n});
  }
  EXPECT_DOUBLE_EQ(silhouette(sheet.points, no_rim(sheet), sheet.triangles, {}, 1e-3).area, once);
  const Sheet flat = ellipse(0.1, 0.1, 0);
  EXPECT_LT(silhouette(flat.points, no_rim(flat), flat.triangles, {{0, 1, 0}, unit(Vec3{0.1, 0, -1})}, 1e-3).area, 0.15 * once);
}

// A cloth is as large as its particles make it: 30 by 15 of a radius of 2 mm are 120 mm by 60 mm, and seen from its edge it has no
// thickness.
TEST(Silhouette, ReachesToTheRim) {
  constexpr double r = 2e-3;
  constexpr int nx = 30, ny = 15;
  Sheet sheet;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      sheet.points.push_back({2 * r * i, 2 * r * j, 0});
      const int a = j * nx + i, b = a + nx;
      if (i + 1 < nx && j + 1 < ny) sheet.triangles.push_back({a, a + 1, b + 1}), sheet.triangles.push_back({a, b + 1, b});
    }
  const std::vector<double> radius(sheet.points.size(), r);
  const Silhouette seen = silhouette(sheet.points, radius, sheet.triangles, {}, 0.1 * r);
  EXPECT_NEAR(seen.area, 0.12 * 0.06, 4e-3 * 0.12 * 0.06);  // of pixels at the rim
  EXPECT_NEAR(seen.elongation_ratio, 2, 0.005);
  EXPECT_LT(silhouette(sheet.points, radius, sheet.triangles, {{1, 0, 0}, {0, 0, 1}}, 0.1 * r).area, 0.12 * 0.2 * r);
}
