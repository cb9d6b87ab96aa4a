// The scatter of the start that a diagnosis runs with.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/effects/effect_model.hpp"

namespace snag {
namespace {

/// Remembers by how much the pieces are turned.
struct Turned final : RunEdit {
  const CaseFeatures& base() const override { return facts; }
  void set(const std::string&) override {}
  void scale(const std::string&, double) override {}
  void add(const std::string&, const Vec3& by) override { moved = by; }
  void move_pieces_inside(double) override {}
  void turn_pieces(double by) override { angle += by; }
  void scale_picture(double, int) override {}
  CaseFeatures facts;
  double angle = 0;
  Vec3 moved;
};

double turn(std::uint64_t seed) {
  Turned run;
  effect_models().make("initial_pose", "test")->change(1, 0, seed, run);
  return run.angle;
}

/// Requirement: angles are standard normal over many seeds, and a handful of seeds that follow each other is no lucky draw: their spread is
/// that of the distribution within a factor of two (of four independent angles it is less than half in one case of ten).
TEST(InitialPose, AnglesAreNormalAndEvenlySpread) {
  double sum = 0, square = 0;
  constexpr int n = 1000, few = 4;
  for (std::uint64_t seed = 1; seed <= n; ++seed) sum += turn(seed), square += turn(seed) * turn(seed);
  EXPECT_NEAR(sum / n, 0, 0.02);
  EXPECT_NEAR(square / n, 1, 0.02);
  for (std::uint64_t first = 1; first <= n; ++first) {
    double mean = 0, variance = 0;
    for (std::uint64_t s = first; s < first + few; ++s) mean += turn(s) / few;
    for (std::uint64_t s = first; s < first + few; ++s) variance += std::pow(turn(s) - mean, 2) / (few - 1);
    EXPECT_LT(std::abs(mean), 1.2) << first;  // of 1000 times four independent angles: 1.6
    EXPECT_GT(std::sqrt(variance), 0.5) << first;
    EXPECT_LT(std::sqrt(variance), 2) << first;
  }
}

/// Requirement: places of the start are normal along each axis, the axes do not depend on each other, and a handful of seeds that follow
/// each other spreads along each as the distribution does, within a factor of two.
TEST(StartPlace, PlacesAreNormalAndEvenlySpread) {
  const auto place = [](std::uint64_t seed) {
    Turned run;
    effect_models().make("start_place", "test")->change(1, 0, seed, run);
    return run.moved;
  };
  constexpr int n = 1000, few = 8;
  Mat3 moment{};
  for (std::uint64_t seed = 1; seed <= n; ++seed) {
    const Vec3 x = place(seed);
    for (int i = 0; i < 3; ++i) moment[i] += (x[i] / n) * x;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(moment[i][j], i == j ? 1 : 0, 0.02) << i << j;
  for (std::uint64_t first = 1; first <= n; ++first) {
    Vec3 mean, variance;
    for (std::uint64_t s = first; s < first + few; ++s) mean += place(s) / few;
    for (std::uint64_t s = first; s < first + few; ++s)
      for (int i = 0; i < 3; ++i) variance[i] += std::pow(place(s)[i] - mean[i], 2) / (few - 1);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(mean[i]), 0.8) << first;  // of 1000 times eight independent places: 1.4
      EXPECT_GT(std::sqrt(variance[i]), 0.5) << first;
      EXPECT_LT(std::sqrt(variance[i]), 2) << first;
    }
  }
}

}  // namespace
}  // namespace snag
