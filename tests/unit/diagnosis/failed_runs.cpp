// Runs that fail on the way of a fit.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <limits>

#include "diagnosis/attribution/discrepancy.hpp"
#include "diagnosis/fitting/fit.hpp"
#include "diagnosis/fitting/response.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

/// 3 + 20 times the relative deviation of a length, which has no room beyond `most`, nor below `least`. The effect is that deviation, too.
class Narrow final : public TestSimulator {
 public:
  Narrow(double least, double most) : least_(least), most_(most) {
    effects_ = {{.name = "longer", .minimum = -1}}, nuisances_ = {{"length", 0.05, {0}}}, slots_ = {{}};
  }

 private:
  static double deviation(const RunRequest& request) {
    return number_of(request.nuisances, "length") + number_of(request.effects, "longer");
  }
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    return {failure(request).empty() ? 3 + 20 * deviation(request) : std::numeric_limits<double>::quiet_NaN()};
  }
  std::string failure(const RunRequest& request) const override {
    return deviation(request) >= least_ && deviation(request) <= most_ ? "" : "no room";
  }
  double least_, most_;
};

/// Requirement: where a run with an input moved up fails, the derivative is that of the other side; where that fails too there is none.
TEST(FailedRuns, DerivativesAreThoseOfTheOtherSide) {
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = 0.1, .calibration_group = "", .numerics_u = 0}};
  experiment.points = {{.id = "A", .case_file = {}}};
  experiment.data = {{.value = 3}};
  for (const auto& [least, most, moved] :
       {std::array{-1.0, 1.0, 3.5}, std::array{-1.0, 0.0, 3.5}, std::array{0.0, 1.0, 3.5}, std::array{0.0, 0.0, 3.0}}) {
    Narrow simulator(least, most);
    Responses responses(experiment, simulator);
    const Linearization base = Fitter(responses).base();
    ASSERT_EQ(base.by_nuisance.size(), 1u);
    EXPECT_NEAR(base.by_nuisance[0][0].value[0], moved, 1e-12) << least << " to " << most;
  }
}

/// Requirement: the same of the strength of an effect.
TEST(FailedRuns, DerivativesByStrengthsAreThoseOfTheOtherSide) {
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = 0.1, .calibration_group = "", .numerics_u = 0}};
  experiment.points = {{.id = "A", .case_file = {}}};
  experiment.data = {{.value = 7}};
  Narrow wide(-1, 1), narrow(-1, 0.21);
  for (Narrow* simulator : {&wide, &narrow}) {
    Responses responses(experiment, *simulator);
    Fitter fitter(responses);
    const Fit fit = fitter.fit({{0}}, Eigen::VectorXd::Constant(1, 0.2));
    EXPECT_NEAR(fit.theta[0], 0.2, 0.02);
    EXPECT_NEAR(fit.linear.J(0, 0) / fit.linear.J(0, 1), 20 / (20 * 0.05), 1e-6);
  }
}

/// Two times of a path, 3 + 20 d and 5 + 20 d of the deviation d of a length, of which the second is not reached beyond `most`; and an
/// effect of a range narrower than a step, from its minimum on, before one that is the deviation.
class Leaves final : public TestSimulator {
 public:
  explicit Leaves(double most) : most_(most) {
    effects_ = {{.name = "late", .minimum = 0, .maximum = 0.01}, {.name = "longer", .minimum = -1}};
    nuisances_ = {{"length", 0.05, {0}}}, slots_ = {{.time = 0}, {.time = 1}};
  }

 private:
  std::vector<double> values(const RunRequest& request, NormalNumbers&) const override {
    const double d = number_of(request.nuisances, "length") + number_of(request.effects, "longer");
    const double late = number_of(request.effects, "late");
    return {3 + 20 * d, d <= most_ ? 5 + 20 * d + 7 * late : std::numeric_limits<double>::quiet_NaN()};
  }
  double most_;
};

Experiment of_two_times() {
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = 0.1, .calibration_group = "", .numerics_u = 0}};
  experiment.points = {{.id = "A", .case_file = {}}};
  experiment.data = {{.time = 0, .value = 3}, {.time = 1, .value = 5}};
  return experiment;
}

/// Requirement: where a run with an input moved up ends before a row, the derivative of this row is that of the other side.
TEST(FailedRuns, RowsThatAMovedRunLacksAreThoseOfTheOtherSide) {
  const Experiment experiment = of_two_times();
  for (const double most : {1.0, 0.0}) {
    Leaves simulator(most);
    Responses responses(experiment, simulator);
    const Linearization base = Fitter(responses).base();
    EXPECT_NEAR(base.by_nuisance[0][0].value[0], 3.5, 1e-12) << most;
    EXPECT_NEAR(base.by_nuisance[0][0].value[1], 5.5, 1e-12) << most;
  }
}

/// Requirement: a strength at the end of a range narrower than a step is moved to the other end, and the columns of the others stay theirs.
TEST(FailedRuns, StrengthsOfANarrowRange) {
  const Experiment experiment = of_two_times();
  Leaves simulator(1);
  Responses responses(experiment, simulator);
  Fitter fitter(responses);
  const Fit fit = fitter.fit({{0, 1}}, Eigen::VectorXd::Zero(2));
  const Eigen::MatrixXd& J = fit.linear.J;
  EXPECT_NEAR(J(0, 0), 0, 1e-6);
  EXPECT_NEAR(J(1, 0), -7 / 0.1, 0.1);
  EXPECT_NEAR(J(0, 1), -20 / 0.1, 0.1);
  EXPECT_NEAR(J(1, 1), -20 / 0.1, 0.1);
  const Effect narrow{.name = "narrow", .sd = 1, .minimum = 0, .maximum = 0.01};
  EXPECT_EQ(step_within_range(narrow, 0, 0.1), 0.01);
  EXPECT_EQ(step_within_range(narrow, 0.01, 0.1), -0.01);
  EXPECT_EQ(step_within_range(narrow, 0.002, 0.001), 0.001);
  EXPECT_EQ(step_within_range(narrow, 0.01, 0.001), -0.001);
}

/// Requirement: a process beside inputs with which nothing runs explains no more than one beside inputs with which all runs.
TEST(FailedRuns, NoProcessIsBesideThem) {
  Experiment experiment;
  experiment.observables = {{.id = "x", .unit = "m", .noise_u = 0.1, .calibration_group = "", .numerics_u = 0}};
  experiment.points = {{.id = "A", .case_file = {}}};
  experiment.data = {{.value = 103}};
  const auto evidence_of_outside = [&](double most) {
    Narrow simulator(-1, most);
    Responses responses(experiment, simulator);
    Fitter fitter(responses);
    return fit_discrepancy(responses, fitter, fitter.fit({}, Eigen::VectorXd())).log_evidence;
  };
  const double anywhere = evidence_of_outside(1e3), near = evidence_of_outside(0.2);
  std::printf("outside: log evidence %.1f, with room nearby only %.1f\n", anywhere, near);
  EXPECT_LT(near, anywhere + 1);
}

}  // namespace
}  // namespace snag
