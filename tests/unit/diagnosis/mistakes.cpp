// Requirement: an input may be wrong by one factor at all points that state it, whatever its values there. What a mistake of the
// measurement says of a run is known where the run has numbers, and as uncertain beyond as the run bends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/data/mistakes.hpp"
#include "diagnosis/fitting/response.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

constexpr double h = 0.1, theta = 0.03;

/// Times h, 2 h, ... of one observable.
std::vector<Slot> slots(int n) {
  std::vector<Slot> all;
  for (int i = 1; i <= n; ++i) all.push_back({0, h * i});
  return all;
}

Experiment experiment_of(int n_points) {
  Experiment experiment;
  for (int p = 0; p < n_points; ++p) experiment.points.push_back({.id = std::string(1, static_cast<char>('A' + p)), .case_file = {}});
  return experiment;
}

void expect_input(const Mistake& mistake, const std::string& name, const std::vector<int>& points, double u) {
  EXPECT_EQ(mistake.effect.name, name);
  EXPECT_EQ(mistake.input, "density");
  EXPECT_EQ(mistake.points, points);
  EXPECT_NEAR(mistake.effect.sd, 10 * u, 1e-12);
  EXPECT_NEAR(mistake.effect.least, 3 * u, 1e-12);
}

/// One value at all points: half of the variance is common. Another value at each: all of it is the point's own.
TEST(Mistakes, InputOfOneValueOrOfSeveralIsWrongByOneFactor) {
  constexpr double u = 0.01, half = u / std::numbers::sqrt2;
  const std::vector<Nuisance> one{{"density", half, {0, 1, 2}}, {"density", half, {0}}, {"density", half, {1}}, {"density", half, {2}}},
      several{{"density", u, {0}}, {"density", 0.5 * u, {1}}, {"density", u, {2}}};
  for (const auto& nuisances : {one, several}) {
    const std::vector<Mistake> found = mistakes_of_inputs(experiment_of(3), nuisances);
    ASSERT_EQ(found.size(), 1u);
    expect_input(found[0], "input:density", {0, 1, 2}, u);
  }
  EXPECT_TRUE(mistakes_of_inputs(experiment_of(3), std::vector<Nuisance>{{"density", u, {1}}}).empty());  // one of several points
  EXPECT_EQ(mistakes_of_inputs(experiment_of(1), std::vector<Nuisance>{{"density", u, {0}}}).size(), 1u);
}

/// Two kinds of spheres: all densities are wrong by one factor, or those of one kind. A kind with one point of training is no hypothesis.
TEST(Mistakes, OneOfSeveralValuesMayBeWrong) {
  constexpr double u = 0.01, half = u / std::numbers::sqrt2;
  Experiment experiment = experiment_of(5);
  experiment.points[4].withheld = true;
  std::vector<Nuisance> nuisances{{"density", half, {0, 2}}, {"density", half, {3, 4}}, {"density", u, {1}}};
  for (const int p : {0, 2, 3, 4}) nuisances.push_back({"density", half, {p}});
  const std::vector<Mistake> found = mistakes_of_inputs(experiment, nuisances);
  ASSERT_EQ(found.size(), 2u);
  expect_input(found[0], "input:density", {0, 1, 2, 3, 4}, u);
  expect_input(found[1], "input:density@A, C", {0, 2}, u);
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

/// Answers a path with 1 + t and its scalar, if there is one, with 3.
class InSeconds final : public TestSimulator {
 public:
  explicit InSeconds(const std::vector<Slot>& at) { slots_ = at; }

 private:
  std::vector<double> values(const RunRequest&, NormalNumbers&) const override {
    std::vector<double> all;
    for (const Slot& slot : slots_) all.push_back(std::isnan(slot.time) ? 3 : 1 + slot.time);
    return all;
  }
};

/// Requirement: a wrong unit of a lognormal quantity, of a path or a scalar, is found by the mean difference of logarithms; its relative
/// bias is not multiplied.
TEST(Mistakes, UnitsOfLognormalQuantities) {
  for (const bool is_path : {false, true}) {
    Experiment experiment;
    experiment.observables = {{.id = "retention_time",
                               .unit = "s",
                               .kind = Observable::Kind::lognormal,
                               .noise_u = 0.05,
                               .bias_u = 0.01,
                               .calibration_group = ""}};
    experiment.points = {{.id = "A", .case_file = {}}};
    const auto at = is_path ? slots(6) : std::vector<Slot>{{}};
    for (const Slot& slot : at) experiment.data.push_back({.time = slot.time, .value = 1050 * (is_path ? 1 + slot.time : 3)});
    InSeconds simulator(at);
    Responses responses(experiment, simulator);
    const auto& effects = responses.effects();
    const auto unit = std::find_if(effects.begin(), effects.end(), [](const Effect& effect) { return effect.name == "unit:s"; });
    ASSERT_NE(unit, effects.end());
    State state = responses.base();
    state.effects = {{static_cast<int>(unit - effects.begin()), 1}}, state.nuisances[0] = 1;
    const Row& row = responses.points().front().rows.front();
    EXPECT_NEAR(responses.run(state, {0}).front().value[0], row.value - std::log(1.05) + 0.01, 1e-9);
  }
}

}  // namespace
}  // namespace snag
