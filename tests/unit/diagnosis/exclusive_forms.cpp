// Requirement: where the forms of a law exclude each other, nothing between them explains what another effect does, and each is as likely.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/fitting/fit.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

constexpr int lift = 0, pressure = 1, n_times = 20;

double time_of(int i) { return (i + 1.0) / n_times; }

/// theta t in the first and the last form, theta (t + sin 6t) in the second; lift adds a third of what they differ by.
double answer(double pressure_strength, int form, double lift_strength, double t) {
  return pressure_strength * (t + (form == 1 ? std::sin(6 * t) : 0)) + lift_strength * std::sin(6 * t) / 3;
}

class Forms final : public TestSimulator {
 public:
  /// `only`: the one form that the law has; -1: all three.
  Forms(bool exclusive, int only) : only_(only) {
    effects_ = {
        {.name = "lift", .mean = 1, .sd = 0.5, .maximum = 4},
        {.name = "pressure_gradient", .mean = 1, .sd = 0.4, .maximum = 3, .n_forms = only < 0 ? 3 : 1, .exclusive_forms = exclusive}};
    for (int i = 0; i < n_times; ++i) slots_.push_back({0, time_of(i)});
  }

 private:
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    const auto chosen = request.forms.find("pressure_gradient");
    const int form = only_ >= 0 ? only_ : chosen == request.forms.end() ? 0 : chosen->second;
    std::vector<double> values;
    for (const Slot& slot : slots_)
      values.push_back(answer(number_of(request.effects, "pressure_gradient"), form, number_of(request.effects, "lift"), slot.time));
    return values;
  }
  int only_;
};

Experiment experiment(double pressure_strength, int form, double lift_strength) {
  constexpr double noise = 0.01;
  Experiment e;
  e.observables = {{.id = "x", .unit = "m", .noise_u = noise, .calibration_group = "", .numerics_u = 0}};
  e.points = {{.id = "A", .case_file = {}}};
  NormalNumbers random(7);
  for (int i = 0; i < n_times; ++i)
    e.data.push_back({.time = time_of(i), .value = answer(pressure_strength, form, lift_strength, time_of(i)) + noise * random()});
  return e;
}

Fit fit_of(const Experiment& experiment, const Hypothesis& hypothesis, bool exclusive, int only = -1) {
  Forms simulator(exclusive, only);
  Responses responses(experiment, simulator);
  return Fitter(responses).fit(hypothesis, Eigen::VectorXd::Ones(static_cast<Eigen::Index>(hypothesis.effects.size())));
}

TEST(ExclusiveForms, NothingBetweenThemExplainsAnotherEffect) {
  const Experiment data = experiment(1, 0, 1);
  const auto gain = [&](bool exclusive) {
    return fit_of(data, {{lift, pressure}}, exclusive).log_evidence - fit_of(data, {{pressure}}, exclusive).log_evidence;
  };
  EXPECT_LT(gain(false), 3);
  EXPECT_GT(gain(true), 10);
}

TEST(ExclusiveForms, EachIsAsLikelyAndTheBestIsKept) {
  const Experiment data = experiment(0.05, 1, 0);  // so weak that the other form explains some of it
  std::vector<double> alone;
  for (const int form : {0, 1, 2}) alone.push_back(fit_of(data, {{pressure}}, true, form).log_evidence);
  const Fit fit = fit_of(data, {{pressure}}, true);
  EXPECT_GT(alone[1], alone[0] + 1);
  EXPECT_EQ(alone[0], alone[2]);
  EXPECT_NEAR(fit.log_evidence, log_sum_exp(alone) - std::log(3.0), 0.05);
  EXPECT_EQ(fit.at.state.form(0), 1);
  EXPECT_EQ(fit.at.state.shares.size(), 0);
}

}  // namespace
}  // namespace snag
