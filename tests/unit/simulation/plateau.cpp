#include "simulation/plateau.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace snag;

namespace {

/// q over x for two groups, the second shifted by `shift`; one result.
std::vector<PlateauRun> runs_of(const std::vector<double>& x, const std::vector<double>& q, double shift = 0) {
  std::vector<PlateauRun> runs;
  for (const bool second : {false, true})
    for (std::size_t i = 0; i < x.size(); ++i) runs.push_back({x[i], second ? "fine" : "coarse", "", {q[i] * (second ? 1 + shift : 1)}});
  return runs;
}

const std::vector<double> widths{2, 4, 6, 8, 12, 16};

}  // namespace

// Too small a width, a plateau from 4 to 12, too large a one.
TEST(Plateau, IsFound) {
  const Plateau found = find_plateau(runs_of(widths, {0.5, 1, 1.01, 0.99, 1.02, 1.5}, 0.01), 0.03, 3);
  ASSERT_TRUE(found.window);
  EXPECT_TRUE(found.window->within_tolerance);
  EXPECT_EQ(found.window->from, 4);
  EXPECT_EQ(found.window->to, 12);
  EXPECT_EQ(found.window->middle, 6);  // sqrt(48) = 6.9 lies nearer to 6 than to 8 in the logarithm
  // The mean of the 8 values is 1.005 times 1.005: the farthest is 0.99.
  EXPECT_NEAR(found.window->deviation, std::max(1 - 0.99 / 1.010025, 1.02 * 1.01 / 1.010025 - 1), 1e-12);
  EXPECT_EQ(found.by_group.size(), 2U);
}

// Each mesh by itself has a plateau, but they differ: no recommendation, and the deviation is the half of their difference.
TEST(Plateau, GroupsThatDisagree) {
  const Plateau found = find_plateau(runs_of(widths, {0.5, 1, 1, 1, 1, 1.5}, 0.2), 0.03, 3);
  ASSERT_TRUE(found.window);
  EXPECT_FALSE(found.window->within_tolerance);
  EXPECT_NEAR(found.window->deviation, 0.1 / 1.1, 1e-12);
  for (const auto& [group, window] : found.by_group) EXPECT_TRUE(window && window->within_tolerance) << group;
}

// Where the difference is physical it is no fault of the choice.
TEST(Plateau, ConditionsMayDiffer) {
  std::vector<PlateauRun> runs = runs_of(widths, {0.5, 1, 1, 1, 1, 1.5}, 0.2);
  for (PlateauRun& run : runs) run.condition = run.group;
  const Plateau found = find_plateau(runs, 0.03, 3);
  ASSERT_TRUE(found.window && found.window->within_tolerance);
  EXPECT_EQ(found.window->deviation, 0);
}

// A result that changes steadily has none, nor has one with a run that failed in the middle, nor one with two values.
TEST(Plateau, IsRefused) {
  const Plateau slope = find_plateau(runs_of(widths, {1, 1.2, 1.4, 1.6, 1.8, 2.0}), 0.03, 3);
  ASSERT_TRUE(slope.window);
  EXPECT_FALSE(slope.window->within_tolerance);
  EXPECT_EQ(slope.window->n, 3U);
  std::vector<PlateauRun> gap = runs_of({2, 4, 6, 8}, {1, 1, 1, 1});
  gap[1].results[0].reset(), gap[2].results[0].reset();
  EXPECT_FALSE(find_plateau(gap, 0.03, 3).window);
  EXPECT_FALSE(find_plateau(runs_of({2, 4}, {1, 1}), 0.03, 3).window);
  // About zero nothing agrees, however small the values are.
  EXPECT_FALSE(find_plateau(runs_of({2, 4, 6}, {1e-9, 0, -1e-9}), 0.03, 3).window->within_tolerance);
}
