// Requirement: what a mistake of the measurement says of a run is known where the run has numbers, and as uncertain beyond as the run
// bends.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnosis/data/mistakes.hpp"

namespace snag {
namespace {

constexpr double h = 0.1, theta = 0.03;

/// Times h, 2 h, ... of one observable.
std::vector<Slot> slots(int n) {
  std::vector<Slot> all;
  for (int i = 1; i <= n; ++i) all.push_back({0, h * i});
  return all;
}

Mistake clock_mistake() {
  Mistake mistake;
  mistake.kind = Mistake::Kind::clock, mistake.observables = {0};
  return mistake;
}

TEST(Mistakes, PathsWithinARunAreCertain) {
  std::vector<double> values;
  const auto at = slots(6);
  for (const Slot& s : at) values.push_back(s.time * s.time);
  const std::vector<double> u = mismeasure(clock_mistake(), theta, at, values);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    EXPECT_NEAR(values[i], std::pow(at[i].time + theta, 2), 1e-12);
    EXPECT_EQ(u[i], 0);
  }
  EXPECT_GT(u.back(), 0);
}

/// An axis comes back after half a turn: between samples it turns on, and does not go back over all other angles.
TEST(Mistakes, AnglesTurnOn) {
  Mistake clock = clock_mistake();
  clock.periods = {{0, std::numbers::pi}};
  std::vector<double> values;
  const auto at = slots(12);
  const auto axis = [](double angle) { return angle - std::numbers::pi * std::round(angle / std::numbers::pi); };
  for (const Slot& s : at) values.push_back(axis(5 * s.time));
  const std::vector<double> u = mismeasure(clock, theta, at, values);
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(axis(values[i] - 5 * (at[i].time + theta)), 0, 1e-9) << i;
    EXPECT_NEAR(u[i], 0, 1e-9) << i;
  }
}

/// The line through the last two samples of t^2 differs from it by (t - t_1)(t - t_2), which is what the parabola adds.
TEST(Mistakes, BeyondARunTheyAreAsUncertainAsItBends) {
  for (const double moved : {theta, -h - theta}) {
    std::vector<double> values, straight;
    const auto at = slots(5);
    for (const Slot& s : at) values.push_back(s.time * s.time), straight.push_back(2 * s.time);
    const std::vector<double> u = mismeasure(clock_mistake(), moved, at, values), none = mismeasure(clock_mistake(), moved, at, straight);
    const std::size_t end = moved > 0 ? 4 : 0;
    const double t = at[end].time + moved, other = at[moved > 0 ? 3 : 1].time;
    EXPECT_NEAR(u[end], std::abs((t - at[end].time) * (t - other)), 1e-12);
    EXPECT_NEAR(std::abs(values[end] - t * t), u[end], 1e-12);
    EXPECT_NEAR(none[end], 0, 1e-12);
    EXPECT_NEAR(straight[end], 2 * t, 1e-12);
  }
}

}  // namespace
}  // namespace snag
