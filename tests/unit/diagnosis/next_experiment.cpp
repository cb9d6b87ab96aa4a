// How many repeats of a measurement distinguish two hypotheses.
#include "diagnosis/judgement/next_experiment.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

/// Two coordinates by an input that is known to 1 %, the first of which an effect changes as the input does, and the second by itself.
class TwoCoordinates final : public TestSimulator {
 public:
  explicit TwoCoordinates(double slope) : slope_(slope) {
    effects_ = {{.name = "push", .mean = 0.1, .sd = 0.1}}, nuisances_ = {{"length", 0.01, {0}}};
    slots_ = {{.observable = 0}, {.observable = 1}};
  }

 private:
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    const double theta = number_of(request.effects, "push"), length = number_of(request.nuisances, "length");
    return {5 + 10 * length + slope_ * theta, 5};
  }
  double slope_;
};

std::string advice(double noise_u, double slope, double bias_u) {
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = noise_u, .bias_u = bias_u, .calibration_group = "", .numerics_u = 0},
                            {.id = "y", .unit = "m", .noise_u = noise_u, .calibration_group = "", .numerics_u = 0}};
  experiment.points = {{.id = "A", .case_file = {}}};
  experiment.data = {{.observable = 0, .value = 5 + 0.5 * slope * 0.1}, {.observable = 1, .value = 5}};
  TwoCoordinates simulator(slope);
  Responses responses(experiment, simulator);
  Fitter fitter(responses);
  Attribution attribution;
  attribution.fits = {fitter.fit({}, Eigen::VectorXd()), fitter.fit({{0}}, Eigen::VectorXd::Constant(1, 0.1))};
  attribution.names = {"none", "push"}, attribution.weight = {0, 0};
  attribution.log_prior = attribution.evidence_penalty = {0, 0}, attribution.remainder.resize(2);
  return next_experiment(responses, attribution, false);
}

/// Requirement: repeats reduce the noise, but neither the uncertainty of the inputs nor the bias: where one of these is as large as the
/// difference of the predictions or larger, no number of repeats is proposed.
TEST(NextExperiment, RepeatsReduceOnlyTheNoise) {
  const std::string noisy = advice(2, 10, 0), uncertain = advice(0.5, 1, 0), biased = advice(2, 10, 2);
  EXPECT_NE(noisy.find("more repeats are enough"), std::string::npos) << noisy;
  EXPECT_EQ(uncertain.find("No number of repeats"), 0) << uncertain;
  EXPECT_EQ(biased.find("No number of repeats"), 0) << biased;
}

}  // namespace
}  // namespace snag
