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
  void turn_pieces(double by) override { angle += by; }
  void scale_picture(double, int) override {}
  CaseFeatures facts;
  double angle = 0;
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

}  // namespace
}  // namespace snag
