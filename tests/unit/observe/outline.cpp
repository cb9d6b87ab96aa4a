#include "observe/outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "observe/silhouette.hpp"

using namespace snag;

namespace {

constexpr double pi = std::numbers::pi;

/// A flower r = mean + amplitude cos(n (angle - turned)) as a fan around (x, y).
Coverage flower(double mean, double amplitude, int n, double turned, double x, double y, double pixel) {
  std::vector<Vec3> points{{x, y, 0}};
  std::vector<std::array<int, 3>> triangles;
  constexpr int n_points = 1440;
  for (int i = 0; i < n_points; ++i) {
    const double angle = 2 * pi * i / n_points, r = mean + amplitude * std::cos(n * (angle - turned));
    points.push_back({x + r * std::cos(angle), y + r * std::sin(angle), 0});
    triangles.push_back({0, 1 + i, 1 + (i + 1) % n_points});
  }
  return covered_by(points, std::vector<double>(points.size(), 0.0), triangles, {}, pixel);
}

}  // namespace

// Requirement: a flower of six petals has six waves of the petals' size where the petals are, and its area, to the size of a pixel.
TEST(Outline, PetalsAreWaves) {
  const Outline seen = outline(flower(0.07, 0.012, 6, 0.3, 0.2, -0.1, 2e-4), {.centre_x = 0.2, .centre_y = -0.1});
  ASSERT_EQ(seen.waves.size(), 6u);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(seen.waves[i].angle, 0.3 + i * pi / 3, 0.02);
  EXPECT_NEAR(seen.mean_wave_size(), 0.082, 5e-4);
  EXPECT_NEAR(seen.smallest_wave(), seen.mean_wave_size(), 2e-4);
  EXPECT_NEAR(seen.area, pi * (0.07 * 0.07 + 0.5 * 0.012 * 0.012), 2e-3 * seen.area);
  EXPECT_NEAR(*std::min_element(seen.radius.begin(), seen.radius.end()), 0.058, 5e-4);
}

// Requirement: a circle has no waves, whatever its pixels do; its size is its radius.
TEST(Outline, CircleHasNoWaves) {
  const Outline seen = outline(flower(0.08, 0, 1, 0, 0, 0, 5e-4), {});
  EXPECT_TRUE(seen.waves.empty());
  EXPECT_NEAR(seen.mean_wave_size(), 0.08, 5e-4);
}

// Requirement: a dent shallower than the prominence splits no wave, a deeper one does.
TEST(Outline, ShallowDentsSplitNoWave) {
  for (const double amplitude : {0.8e-3, 1.3e-3}) {
    const Outline seen = outline(flower(0.08, amplitude, 5, 0.1, 0, 0, 1e-4), {.prominence = 2e-3});
    EXPECT_EQ(seen.waves.size(), amplitude < 1e-3 ? 0u : 5u);
  }
}
