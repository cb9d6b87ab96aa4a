// Requirement: draws from a posterior have the mean and the covariance of the linear model that they are drawn from, also where two
// parameters trade off or a bound cuts off most of the mass; posterior.json has them chain by chain.
#include "diagnosis/judgement/posterior.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

namespace snag {
namespace {

constexpr int n = 4000;

/// Two strengths that do nearly the same, and an input.
LinearModel trade_off(double lower, double upper) {
  LinearModel linear;
  linear.J.resize(3, 3);
  linear.J << 10, 9.8, 0.5, 10, 9.9, -0.5, 0.2, -0.2, 0.3;
  linear.rho.resize(3), linear.prior.resize(3);
  linear.rho << -12, -11, 0.3;
  linear.prior << 0.4, -0.2, 0;
  linear.lower = Eigen::Vector2d::Constant(lower), linear.upper = Eigen::Vector2d::Constant(upper);
  return linear;
}

double sd(const Eigen::RowVectorXd& x) { return std::sqrt((x.array() - x.mean()).square().sum() / static_cast<double>(x.size() - 1)); }

TEST(Posterior, MeanAndCovarianceOfTheLinearModel) {
  const LinearModel linear = trade_off(-100, 100);
  const LinearSolution exact = solve(linear);
  const Eigen::MatrixXd d = posterior_of(linear, n, 3);
  ASSERT_EQ(d.cols(), n);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double u = std::sqrt(exact.covariance(i, i));
    EXPECT_NEAR(d.row(i).mean(), exact.d[i], 4 * u / std::sqrt(n)) << i;
    EXPECT_NEAR(sd(d.row(i)) / u, 1, 4 / std::sqrt(2.0 * n)) << i;
  }
  const Eigen::RowVectorXd a = d.row(0).array() - d.row(0).mean(), b = d.row(1).array() - d.row(1).mean();
  const double correlation = a.dot(b) / (a.norm() * b.norm());
  const double wanted = exact.covariance(0, 1) / std::sqrt(exact.covariance(0, 0) * exact.covariance(1, 1));
  EXPECT_LT(wanted, -0.95);
  EXPECT_NEAR(correlation, wanted, 4 * (1 - wanted * wanted) / std::sqrt(n));
}

TEST(Posterior, BoundsCutOffWhatTheyShould) {
  const LinearModel linear = trade_off(0, 2);
  const Eigen::MatrixXd d = posterior_of(linear, n, 4);
  EXPECT_GE(d.topRows(2).minCoeff(), 0);
  EXPECT_LE(d.topRows(2).maxCoeff(), 2);
  // By quadrature over both strengths, the input integrated out.
  const LinearSolution exact = solve(trade_off(-100, 100));
  const Eigen::Matrix2d A = exact.covariance.topLeftCorner(2, 2).inverse();
  double mass = 0, mean = 0, square = 0;
  constexpr int steps = 600;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const Eigen::Vector2d x((i + 0.5) * 2 / steps, (j + 0.5) * 2 / steps), off = x - exact.d.head(2);
      const double p = std::exp(-0.5 * off.dot(A * off));
      mass += p, mean += p * x[0], square += p * x[0] * x[0];
    }
  mean /= mass;
  const double u = std::sqrt(square / mass - mean * mean);
  EXPECT_NEAR(d.row(0).mean(), mean, 6 * u / std::sqrt(n));  // weighted draws count as fewer
  EXPECT_NEAR(sd(d.row(0)) / u, 1, 0.07);
}

// The data want a strength 40 standard deviations below the bound: what is left of it falls off exponentially, with length 1/40.
TEST(Posterior, FarBeyondABound) {
  LinearModel linear;
  linear.J = Eigen::MatrixXd::Zero(1, 1), linear.rho = Eigen::VectorXd::Zero(1), linear.prior = Eigen::VectorXd::Constant(1, -40);
  linear.lower = Eigen::VectorXd::Zero(1), linear.upper = Eigen::VectorXd::Constant(1, infinity);
  const Eigen::MatrixXd d = posterior_of(linear, n, 5);
  EXPECT_GE(d.minCoeff(), 0);
  EXPECT_NEAR(d.mean() * 40, 1, 4 / std::sqrt(n));
}

TEST(Posterior, LayoutOfTheFile) {
  PosteriorDraws posterior{.hypothesis = "lift"};
  posterior.variables.push_back({.name = "lift", .unit = "1"});
  for (int i = 0; i < n_posterior_draws; ++i) posterior.variables[0].draws.push_back(i + 0.123456789012);
  const auto json = nlohmann::json::parse(posterior_json(posterior));
  ASSERT_EQ(json["posterior"]["lift"].size(), n_posterior_chains);
  EXPECT_EQ(json["posterior"]["lift"][1].size(), n_posterior_draws / n_posterior_chains);
  EXPECT_NEAR(json["posterior"]["lift"][1][0].get<double>(), n_posterior_draws / n_posterior_chains + 0.123457, 1e-6);
  EXPECT_EQ(json["posterior_attrs"]["hypothesis"], "lift");
}

}  // namespace
}  // namespace snag
