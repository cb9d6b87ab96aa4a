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
