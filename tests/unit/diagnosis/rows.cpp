// Rows of the data against runs: covariances of mixed units, biases, times that no run shows, data that are all censored.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "diagnosis/fit.hpp"
#include "diagnosis/response.hpp"

namespace snag {
namespace {

/// Requirement: a row's variance is not touched by what is measured beside it in another unit.
TEST(Rows, CovarianceKeepsUnitsApart) {
  PointSummary point;
  point.n_gaussian = 2;
  for (int observable : {0, 1}) point.rows.push_back({.kind = Row::Kind::scalar, .observable = observable});
  point.covariance = Eigen::Vector2d(1e-8, 1e8).asDiagonal();  // u of 1e-4 m and of 1e4 Pa
  Response response;
  response.value = response.scatter = Eigen::Vector2d::Zero();
  const Eigen::MatrixXd C = model_covariance(point, response, Eigen::Vector2d::Zero(), {});
  EXPECT_NEAR(C(0, 0) / 1e-8, 1, 1e-6);
  EXPECT_NEAR(C(1, 1) / 1e8, 1, 1e-6);
}

/// Answers every slot with one number, or with none.
class Constant : public Simulator {
 public:
  explicit Constant(double value) : value_(value) {}
  std::vector<Nuisance> known{};
  const std::vector<Effect>& effects() const override { return effects_; }
  const std::vector<Nuisance>& nuisances() const override { return known; }
  const std::vector<Slot>& slots(int) const override { return slots_; }
  std::vector<RunResult> run(std::span<const RunRequest> requests) override {
    return std::vector<RunResult>(requests.size(), {{value_}, ""});
  }
  int n_runs() const override { return 0; }

 private:
  double value_;
  std::vector<Effect> effects_;
  std::vector<Slot> slots_{{}};
};

Experiment of_one_row(const Observable& observable, const std::vector<Datum>& data) {
  Experiment experiment;
  experiment.observables = {observable}, experiment.data = data;
  experiment.points.push_back({.id = "A", .case_file = {}});
  return experiment;
}

/// Requirement: a bias that the simulator applies is free once, with a calibration group or without.
TEST(Rows, BiasIsCountedOnce) {
  const Experiment experiment =
      of_one_row({.id = "x", .unit = "m", .noise_u = 1e-4, .bias_u = 1e-3, .calibration_group = ""}, {{.value = 0.5}});
  Constant simulator(0.4);
  EXPECT_EQ(Responses(experiment, simulator).nuisances().size(), 1u);
  simulator.known = {{"bias of x", 1, {0}}};
  const Responses responses(experiment, simulator);
  ASSERT_EQ(responses.nuisances().size(), 1u);
  EXPECT_TRUE(responses.nuisances()[0].of_data);
}

}  // namespace
}  // namespace snag
