// Requirement: where an input that is far off stands for an effect, the screening beside the fit promises what a fit of the effect reaches.
// An effect that data do not distinguish from a wrong input is not named alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "diagnosis/attribution/screening.hpp"
#include "diagnosis/diagnose.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

constexpr int n_times = 30;

double time_of(int i) { return (i + 1.0) / n_times; }
/// An input and an effect that do the same, far from linear.
double answer(double phase, double t) { return std::sin(6 * t + 4 * phase * t); }

class Phase final : public TestSimulator {
 public:
  Phase() {
    effects_ = {{.name = "effect", .mean = 0.4, .sd = 0.2, .minimum = -1, .maximum = 2}}, nuisances_ = {{"input", 0.05, {0}}};
    for (int i = 0; i < n_times; ++i) slots_.push_back({0, time_of(i)});
  }

 private:
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    std::vector<double> values;
    for (const Slot& slot : slots_)
      values.push_back(answer(number_of(request.nuisances, "input") + number_of(request.effects, "effect"), slot.time));
    return values;
  }
};

TEST(InputForEffect, ScreeningInItsPlacePromisesWhatTheFitReaches) {
  Experiment experiment;
  constexpr double noise = 1e-3;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = noise, .calibration_group = "", .numerics_u = 0}};
  experiment.points = {{.id = "A", .case_file = {}}};
  NormalNumbers random(3);
  for (int i = 0; i < n_times; ++i) experiment.data.push_back({.time = time_of(i), .value = answer(0.4, time_of(i)) + noise * random()});
  Phase simulator;
  Responses responses(experiment, simulator);
  Fitter fitter(responses);
  const Fit none = fitter.fit({}, Eigen::VectorXd());
  ASSERT_GT(none.at.state.nuisances[0], 5);
  const Screening screening(responses, fitter, {0}, none.at);
  const double reached = fitter.fit({{0}}, Eigen::VectorXd::Constant(1, 0.4)).log_evidence;
  const Screened linear = screening.screen({{0}}), in_its_place = screening.screen_in_place_of("input", 0, {{0}});
  std::printf("evidence: none %.1f, effect %.1f, screened %.1f, in the place of the input %.1f\n", none.log_evidence, reached,
              linear.log_evidence, in_its_place.log_evidence);
  EXPECT_GT(reached, none.log_evidence + 6);
  EXPECT_LT(linear.log_evidence, none.log_evidence);
  EXPECT_GT(in_its_place.log_evidence, reached - 6);  // what a further effect has to bring
  EXPECT_NEAR(in_its_place.theta[0], 0.4, 0.05);
}

/// Paths at a speed that an effect and an input of every point change by the same factor, which says nothing of which of the two it is.
class Speed final : public TestSimulator {
 public:
  Speed(int n_points, double u) {
    effects_ = {{.name = "effect", .mean = 0.2, .sd = 0.2, .minimum = -1, .maximum = 2},
                {.name = "other", .mean = 0.2, .sd = 0.2, .minimum = -1, .maximum = 2}};
    for (int p = 0; p < n_points; ++p) nuisances_.push_back({"speed", u, {p}});
    for (int i = 0; i < n_times; ++i) slots_.push_back({0, time_of(i)});
  }
  static double answer(int point, double factor, double other, double t) { return (1 + point) * factor * t + other * t * t; }

 private:
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    const double factor = (1 + number_of(request.nuisances, "speed")) * (1 + number_of(request.effects, "effect"));
    std::vector<double> values;
    for (const Slot& slot : slots_) values.push_back(answer(request.point, factor, number_of(request.effects, "other"), slot.time));
    return values;
  }
};

/// Of a speed that is 1.3 times what it should be.
Verdict verdict_on_speed(double u) {
  constexpr int n_points = 3;
  constexpr double noise = 1e-2;
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = noise, .calibration_group = "", .numerics_u = 0}};
  NormalNumbers random(3);
  for (int p = 0; p < n_points; ++p) {
    experiment.points.push_back({.id = std::string(1, static_cast<char>('A' + p)), .case_file = {}});
    for (int i = 0; i < n_times; ++i)
      experiment.data.push_back({.point = p, .time = time_of(i), .value = Speed::answer(p, 1.3, 0, time_of(i)) + noise * random()});
  }
  experiment.candidates = {"effect", "other", "input:speed"};
  Speed simulator(n_points, u);
  return diagnose(experiment, simulator);
}

TEST(InputForEffect, EffectThatAnInputEqualsIsNotCertain) {
  const Verdict verdict = verdict_on_speed(0.02);
  EXPECT_EQ(verdict.verdict, VerdictKind::effects);
  EXPECT_EQ(verdict.effects, std::vector<std::string>{"effect"});
  EXPECT_EQ(verdict.wording, Wording::suspected);
  EXPECT_EQ(verdict.alternatives, std::vector<std::string>{"input:speed"});
}

// An input that is known far too well to be wrong by so much is none.
TEST(InputForEffect, EffectBeyondWhatAnInputCanBe) {
  const Verdict verdict = verdict_on_speed(0.004);
  EXPECT_EQ(verdict.effects, std::vector<std::string>{"effect"});
  EXPECT_EQ(verdict.wording, Wording::attributed);
  EXPECT_TRUE(verdict.alternatives.empty());
}

}  // namespace
}  // namespace snag
