// Requirement: where an input that is far off stands for an effect, the screening beside the fit promises what a fit of the effect reaches.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "diagnosis/attribution/screening.hpp"
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

}  // namespace
}  // namespace snag
