#include "simulation/step/step_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace snag;

namespace {

/// Trials with 60, 120, 240 ... steps a revolution; the same means in all three revolutions. [trial][quantity]
std::vector<StepTrial> trials_of(const std::vector<std::vector<double>>& values) {
  std::vector<StepTrial> trials;
  for (std::size_t i = 0; i < values.size(); ++i) trials.push_back({60 << i, {values[i], values[i], values[i]}});
  return trials;
}

/// Head and torque with a relative error c h^p, h = 1, 1/2, 1/4 ...
std::vector<StepTrial> of_order(double order, double c, int n) {
  std::vector<std::vector<double>> values;
  for (int i = 0; i < n; ++i) {
    const double error = c * std::exp2(-order * i);
    values.push_back({3.3 * (1 + error), -10.8 * (1 - error)});
  }
  return trials_of(values);
}

}  // namespace

// Two trials show no order: the first one is assumed, and with the factor of safety the smaller step has 1.25 of the difference as its
// error.
TEST(StepChoice, OfTwoTrials) {
  const StepChoice good = choose_step(trials_of({{1.002, 1}, {1, 1}}), 0.005);
  ASSERT_TRUE(good.chosen);
  EXPECT_EQ(*good.chosen, 0U);
  EXPECT_NEAR(good.error[0][0], 0.0045, 1e-12);
  EXPECT_NEAR(good.error[1][0], 0.0025, 1e-12);
  const StepChoice finer = choose_step(trials_of({{1.003, 1}, {1, 1}}), 0.005);
  ASSERT_TRUE(finer.chosen);
  EXPECT_EQ(*finer.chosen, 1U);
  EXPECT_FALSE(choose_step(trials_of({{1.006, 1}, {1, 1}}), 0.005).chosen);
}

// Where the trials have an order, the estimate is the true error with the factor of safety on that of the finest trial: never below it.
TEST(StepChoice, ErrorIsThatOfTheOrder) {
  for (const double order : {0.75, 1.0, 1.5, 2.0}) {
    const double c = 0.02;
    const StepChoice choice = choose_step(of_order(order, c, 3), 0.005);
    EXPECT_TRUE(choice.converges && choice.has_settled);
    for (int i = 0; i < 3; ++i)
      for (const double error : choice.error[i]) {
        const double exact = c * std::exp2(-order * i), finest = c * std::exp2(-2 * order);
        EXPECT_NEAR(error, exact + 0.25 * finest, 0.03 * c) << order << ", trial " << i;
        EXPECT_GT(error, 0.99 * exact) << order << ", trial " << i;
      }
  }
}

// A chosen step is as accurate as asked for, the next larger one is not.
TEST(StepChoice, TakesTheLargestAccurateStep) {
  const StepChoice choice = choose_step(of_order(2, 0.04, 4), 0.005);  // errors of 4, 1, 0.25, 0.0625 %
  ASSERT_TRUE(choice.chosen);
  EXPECT_EQ(*choice.chosen, 2U);
}

// One quantity is not enough: the torque decides as well.
TEST(StepChoice, EveryQuantityCounts) { EXPECT_EQ(choose_step(trials_of({{1, 1.02}, {1, 1.005}, {1, 1.001}}), 0.005).chosen, 2U); }

// The first two agree by accident, and the third one shows it: neither of them counts.
TEST(StepChoice, AnAccidentIsNoConvergence) {
  const StepChoice choice = choose_step(trials_of({{1, 1}, {1.0001, 1}, {1.01, 1}}), 0.005);
  EXPECT_FALSE(choice.converges);
  EXPECT_FALSE(choice.chosen);
  const StepChoice finer = choose_step(trials_of({{1, 1}, {1.0001, 1}, {1.01, 1}, {1.0105, 1}}), 0.005);
  EXPECT_EQ(finer.chosen, 2U);
}

// Noise of alternating sign: no order is read from it.
TEST(StepChoice, NoiseHasNoOrder) {
  const StepChoice choice = choose_step(trials_of({{1.003, 1}, {1, 1}, {1.003, 1}}), 0.005);
  EXPECT_FALSE(choice.converges);
  EXPECT_NEAR(choice.error[2][0], 1.25 * 0.003 / 1.003, 1e-12);  // as if of first order
  EXPECT_EQ(choice.chosen, 2U);
}

// What all trials share, a flow that still rises by 5 % a revolution, is no error by the step.
TEST(StepChoice, ACommonDriftCancels) {
  std::vector<StepTrial> trials = of_order(2, 0.002, 2);
  for (StepTrial& trial : trials)
    for (std::size_t k = 0; k < 3; ++k)
      for (double& mean : trial.means[k]) mean *= 1 + 0.05 * static_cast<double>(k);
  const StepChoice choice = choose_step(trials, 0.005);
  EXPECT_TRUE(choice.has_settled);
  EXPECT_EQ(choice.chosen, 0U);
}

// A difference that changes from revolution to revolution has not reached its end: its change counts as an error.
TEST(StepChoice, ADifferenceThatChangesCounts) {
  const std::vector<StepTrial> trials{{60, {{1, 1}, {1, 1}, {1, 1}}}, {120, {{1, 1}, {0.9955, 1}, {0.9985, 1}}}};
  const StepChoice choice = choose_step(trials, 0.0029);
  EXPECT_FALSE(choice.has_settled);
  EXPECT_NEAR(choice.error[1][0], (1.25 * 0.0015 + 0.003) / 0.9985, 1e-12);
  EXPECT_FALSE(choice.chosen);
}

// Without a head there is nothing to compare with; numbers that are none are not accurate.
TEST(StepChoice, NothingToCompare) {
  EXPECT_FALSE(choose_step(trials_of({{0, 1}, {0, 1}}), 0.005).chosen);
  EXPECT_FALSE(choose_step(trials_of({{NAN, 1}, {1, 1}}), 0.005).chosen);
  EXPECT_FALSE(choose_step(trials_of({{1, 1}, {NAN, 1}}), 0.005).chosen);
}

// One row in each trial, as of a rag.
TEST(StepChoice, OfSingleRows) {
  const StepChoice choice = choose_step({{60, {{0.101, 1}}}, {120, {{0.1, 1}}}}, 0.03);
  EXPECT_EQ(choice.chosen, 0U);
  EXPECT_TRUE(choice.has_settled);
}
