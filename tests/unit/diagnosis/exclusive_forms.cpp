// Requirement: where the forms of a law exclude each other, nothing between them explains what another effect does, and each is as likely.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/fitting/fit.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {
namespace {

constexpr int lift = 0, pressure = 1, n_times = 20;

double time_of(int i) { return (i + 1.0) / n_times; }

/// theta t in the first and the last form, theta (t + sin 6t) in the second; lift adds a third of what they differ by.
double answer(double pressure_strength, int form, double lift_strength, double t) {
  return pressure_strength * (t + (form == 1 ? std::sin(6 * t) : 0)) + lift_strength * std::sin(6 * t) / 3;
}

class Forms final : public Simulator {
 public:
  /// `only`: the one form that the law has; -1: all three.
  Forms(bool exclusive, int only) : only_(only) {
    effects_[pressure].exclusive_forms = exclusive;
    effects_[pressure].n_forms = only < 0 ? 3 : 1;
    for (int i = 0; i < n_times; ++i) slots_.push_back({0, time_of(i)});
  }
  const std::vector<Effect>& effects() const override { return effects_; }
  const std::vector<Nuisance>& nuisances() const override { return nuisances_; }
  const std::vector<Slot>& slots(int) const override { return slots_; }
  std::vector<RunResult> run(std::span<const RunRequest> requests) override {
    std::vector<RunResult> results;
    for (const RunRequest& request : requests) {
      const auto strength = [&](const char* name) { return request.effects.contains(name) ? request.effects.at(name) : 0.0; };
      const int form = only_ >= 0 ? only_ : request.forms.contains("pressure_gradient") ? request.forms.at("pressure_gradient") : 0;
      results.emplace_back();
      for (const Slot& slot : slots_)
        results.back().values.push_back(answer(strength("pressure_gradient"), form, strength("lift"), slot.time));
    }
    return results;
  }
  int n_runs() const override { return 0; }

 private:
  int only_;
  std::vector<Effect> effects_{{.name = "lift", .mean = 1, .sd = 0.5, .maximum = 4},
                               {.name = "pressure_gradient", .mean = 1, .sd = 0.4, .maximum = 3}};
  std::vector<Nuisance> nuisances_;
  std::vector<Slot> slots_;
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
