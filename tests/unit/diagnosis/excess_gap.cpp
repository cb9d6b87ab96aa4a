// The shrinkage of a gap and its interval, on errors of known size.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/judgement/excess_gap.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {
namespace {

constexpr int n_points = 3, n_rows = 40;

/// Errors of this size in every row, with noise of variance 1.
WithheldError with_noise(double bias, const std::vector<Eigen::VectorXd>& noise) {
  WithheldError gap;
  for (const Eigen::VectorXd& e : noise) {
    Eigen::VectorXd error = e;
    for (Eigen::Index i = 0; i < error.size(); ++i) error[i] += i % 2 == 0 ? bias : -bias;
    gap.error.push_back(error);
    gap.covariance.push_back(Eigen::MatrixXd::Identity(n_rows, n_rows)), gap.noise.push_back(Eigen::MatrixXd::Identity(n_rows, n_rows));
    gap.by_strength.emplace_back(n_rows, 0);
  }
  return gap;
}

/// Requirement: the 95 % interval holds the true shrinkage in about so many experiments, not in fewer, and not in all.
TEST(ExcessGap, IntervalHoldsTheTruthAsOftenAsItSays) {
  constexpr double before = 1, after = 0.6, truth = 1 - after * after / (before * before);
  NormalNumbers random(5);
  int held = 0;
  constexpr int n = 200;
  for (int k = 0; k < n; ++k) {
    std::vector<Eigen::VectorXd> noise(n_points, Eigen::VectorXd(n_rows));
    for (Eigen::VectorXd& e : noise)
      for (double& v : e) v = random();
    const Shrinkage s = shrinkage(with_noise(before, noise), with_noise(after, noise), static_cast<std::uint64_t>(k));
    held += s.low <= truth && truth <= s.high;
  }
  EXPECT_GE(held, 0.90 * n);
  EXPECT_LE(held, 0.98 * n);
}

/// Requirement: without noise the shrinkage is the ratio of the squares; no gap has none.
TEST(ExcessGap, RatioOfSquares) {
  const std::vector<Eigen::VectorXd> none(n_points, Eigen::VectorXd::Zero(n_rows));
  WithheldError before = with_noise(2, none), after = with_noise(1, none), nothing = with_noise(0, none);
  for (WithheldError* gap : {&before, &after, &nothing})
    for (Eigen::MatrixXd& C : gap->covariance) C.setZero();
  EXPECT_NEAR(excess_gap(before), 4, 1e-12);
  EXPECT_NEAR(shrinkage(before, after, 1).mean, 0.75, 1e-12);
  EXPECT_TRUE(std::isnan(shrinkage(nothing, nothing, 1).mean));
  EXPECT_DOUBLE_EQ(noise_floor(with_noise(3, none)), 1);
}

/// Requirement: of experiments without a gap one in twenty is told a shrinkage; where the noise is small against the gap none is refused.
TEST(ExcessGap, NoiseDoesNotShrink) {
  NormalNumbers random(11);
  int told = 0, refused = 0;
  constexpr int n = 400;
  for (int k = 0; k < n; ++k) {
    std::vector<Eigen::VectorXd> noise(n_points, Eigen::VectorXd(n_rows));
    for (Eigen::VectorXd& e : noise)
      for (double& v : e) v = random();
    const auto seed = static_cast<std::uint64_t>(k);
    told += std::isfinite(shrinkage(with_noise(0, noise), with_noise(0, noise), seed).mean);
    refused += std::isnan(shrinkage(with_noise(1, noise), with_noise(0, noise), seed).mean);
  }
  EXPECT_GE(told, 0.02 * n);  // 0.05 expected, standard deviation 0.011
  EXPECT_LE(told, 0.09 * n);
  EXPECT_EQ(refused, 0);
}

}  // namespace
}  // namespace snag
