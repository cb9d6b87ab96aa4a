// Between runs at some strengths of one effect.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "diagnosis/fitting/emulator.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {
namespace {

double curve(double theta) { return 2 + theta - 0.6 * theta * theta; }

/// One row at one point, run at these strengths with this scatter of the mean of four runs.
Emulator emulator_of(const std::vector<double>& strengths, double u, std::uint64_t seed) {
  NormalNumbers random(seed);
  constexpr int n_runs = 4;
  std::vector<std::vector<Response>> responses;
  for (const double theta : strengths) {
    Response response;
    response.value = Eigen::VectorXd::Constant(1, curve(theta) + u * random());
    response.scatter = Eigen::VectorXd::Constant(1, n_runs * u * u);
    response.n_runs = n_runs;
    responses.push_back({response});
  }
  return Emulator(strengths, responses);
}

const std::vector<double> strengths{0, 0.1, 0.3, 0.6, 1, 1.5, 2};

/// Requirement: runs without chance are met where they are, and a smooth curve between them to 1 % of its range.
TEST(Emulator, PassesThroughRunsWithoutScatter) {
  const Emulator emulator = emulator_of(strengths, 0, 1);
  for (const double theta : strengths) EXPECT_NEAR(emulator.at(theta)[0].value[0], curve(theta), 1e-4);
  for (int i = 0; i < 20; ++i) {
    const double theta = 0.05 + 0.1 * i;
    EXPECT_NEAR(emulator.at(theta)[0].value[0], curve(theta), 0.02) << theta;
  }
}

/// Requirement: where runs scatter, what stands between them is nearer to the truth than the runs are.
TEST(Emulator, SmoothsWhatScatters) {
  constexpr double u = 0.2;
  double emulated = 0, run = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Emulator emulator = emulator_of(strengths, u, seed);
    for (const double theta : strengths) emulated += std::pow(emulator.at(theta)[0].value[0] - curve(theta), 2), run += u * u;
  }
  EXPECT_LT(emulated, 0.7 * run);
}

/// Requirement: a row that some runs have no number for is that of the nearest run.
TEST(Emulator, LeavesGapsAlone) {
  std::vector<std::vector<Response>> responses;
  for (const double value : {1.0, std::numeric_limits<double>::quiet_NaN(), 4.0}) {
    Response response;
    response.value = Eigen::VectorXd::Constant(1, value), response.scatter = Eigen::VectorXd::Zero(1);
    responses.push_back({response});
  }
  const Emulator emulator({0, 1, 2}, responses);
  EXPECT_EQ(emulator.at(0.2)[0].value[0], 1);
  EXPECT_TRUE(std::isnan(emulator.at(1.1)[0].value[0]));
  EXPECT_EQ(emulator.at(1.9)[0].value[0], 4);
}

}  // namespace
}  // namespace snag
