#include "diagnosis/statistics/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/statistics/lifetimes.hpp"
#include "diagnosis/statistics/linear_model.hpp"

using namespace snag;

// Water and rags in the suction pipe: nine operating points, m/s (Jensen 2018, Table A.2).
namespace suction_pipe {
const std::vector<double> fluid{1.50, 1.86, 2.26, 2.26, 2.79, 3.40, 3.01, 3.71, 4.53};
const std::vector<double> textile{1.53, 1.87, 2.27, 2.25, 2.79, 3.40, 2.87, 3.52, 4.28};
}  // namespace suction_pipe

// Velocity ratio of textile and water: a step at the third group of speeds describes it better than a line in velocity.
TEST(Statistics, StepOfTheVelocityRatio) {
  using namespace suction_pipe;
  std::vector<double> ratio;
  std::vector<bool> first;
  for (int i = 0; i < 9; ++i) ratio.push_back(textile[i] / fluid[i]), first.push_back(i < 6);
  EXPECT_NEAR(bic_of_line(fluid, ratio), -71.1, 0.05);
  EXPECT_NEAR(bic_of_step(first, ratio), -85.8, 0.05);
}

// Retention time at best efficiency: 239 ms, scatter 75 ms, 50 rags, against 130 ms from so many simulated rags of the same scatter.
TEST(Statistics, RetentionTimeOfTheThesis) {
  const auto z = [](int n_simulated) { return (130 - 239) / (75 * std::sqrt(1.0 / 50 + 1.0 / n_simulated)); };
  EXPECT_NEAR(z(1), -1.4, 0.05);
  EXPECT_NEAR(z(5), -3.1, 0.05);
}

// At most 2 of 50 rags left without recirculating.
TEST(Statistics, ClopperPearson) {
  const auto [low, high] = clopper_pearson(2, 50);
  EXPECT_NEAR(low, 0.005, 0.0005);
  EXPECT_NEAR(high, 0.137, 0.0005);
  EXPECT_EQ(clopper_pearson(0, 10)[0], 0);
  EXPECT_EQ(clopper_pearson(10, 10)[1], 1);
  EXPECT_NEAR(clopper_pearson(0, 10)[1], 1 - std::pow(0.025, 0.1), 1e-12);
  EXPECT_LT(fisher_exact(2, 50, 1, 1), 0.06 + 1e-9);  // one simulated rag that does so: 3/51
  EXPECT_NEAR(fisher_exact(2, 50, 1, 1), 3.0 / 51, 1e-12);
}

// Textbook cases: lady tasting tea; acute leukaemia, 6-MP against placebo (Freireich 1963): log-rank chi2 16.79.
TEST(Statistics, ExactAndCensoredTests) {
  EXPECT_NEAR(fisher_exact(3, 4, 1, 4), 0.4857142857, 1e-9);
  std::vector<Lifetime> drug, placebo;
  for (const double t : {6, 6, 6, 7, 10, 13, 16, 22, 23}) drug.push_back({t, false});
  for (const double t : {6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35}) drug.push_back({t, true});
  for (const double t : {1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23}) placebo.push_back({t, false});
  const LogRank test = log_rank(drug, placebo);
  EXPECT_NEAR(test.z * test.z, 16.79, 0.01);
  EXPECT_LT(test.z, 0);
  EXPECT_NEAR(equal_rates(8, 1, 2, 1), 0.109375, 1e-9);
  EXPECT_GT(equal_rates(8, 1, 2, 1, 4), 0.9);
}

TEST(Statistics, DistancesOfDistributions) {
  const std::vector<double> a{0, 1}, b{2, 3}, c{0, 1};
  EXPECT_DOUBLE_EQ(energy_distance(a, b), 2 * 2 - 0.5 - 0.5);
  EXPECT_DOUBLE_EQ(energy_distance(a, c), 0);
  NormalNumbers random(3);
  std::vector<double> x, near, far;
  for (int i = 0; i < 60; ++i) x.push_back(random()), near.push_back(random()), far.push_back(random() * 3);
  EXPECT_GT(energy_test(x, near, 1), 0.02);
  EXPECT_LT(energy_test(x, far, 1), 0.005);
}

// A million measured values against 60 simulated ones take as long as 500 and say the same.
TEST(Statistics, EnergyTestOfAMillionValues) {
  NormalNumbers random(4);
  std::vector<double> many, alike, narrow;
  for (int i = 0; i < 1000000; ++i) many.push_back(random());
  for (int i = 0; i < 60; ++i) alike.push_back(random()), narrow.push_back(0.4 * random());
  EXPECT_GT(energy_test(many, alike, 1), 0.02);
  EXPECT_LT(energy_test(many, narrow, 1), 0.005);
}

TEST(Statistics, FalseDiscoveryRate) {
  const std::vector<double> p{0.001, 0.008, 0.039, 0.041, 0.042, 0.06, 0.074, 0.205, 0.212, 0.216};
  const auto rejected = benjamini_hochberg(p);  // Benjamini and Hochberg's own example rejects the first two
  EXPECT_EQ(std::count(rejected.begin(), rejected.end(), true), 2);
}

// A censored fit without censoring is the mean; half the times cut at the true median leave it in place.
TEST(Lifetimes, CensoredFit) {
  NormalNumbers random(5);
  std::vector<double> times;
  for (int i = 0; i < 400; ++i) times.push_back(1 + 0.4 * random());
  const LogTimes all = fit_log_times(times, std::vector<bool>(400, false), 0);
  EXPECT_NEAR(all.u_mean, all.sigma / 20, 1e-6);
  std::vector<bool> censored;
  for (double& t : times) censored.push_back(t > 1), t = std::min(t, 1.0);
  const LogTimes cut = fit_log_times(times, censored, 0);
  EXPECT_NEAR(cut.mean, all.mean, 3 * cut.u_mean);
  EXPECT_NEAR(cut.sigma, 0.4, 0.08);
  EXPECT_GT(cut.u_mean, all.u_mean);
  EXPECT_TRUE(std::isinf(fit_log_times({1, 1}, {true, true}, 0).u_mean));
}

// Integrals over boxes of three parameters against sums: correlated ones whose bounds cut them at the centre and in the tail, to 0.05 nats.
TEST(LinearModel, BoxOfThreeParameters) {
  const Eigen::Matrix3d A{{3, 1, 0.5}, {1, 2, -0.6}, {0.5, -0.6, 1.5}};
  const Eigen::Vector3d lower(0, -1, 0.2), upper(2, 0.5, 3);
  for (const Eigen::Vector3d& g : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, -3, 1), Eigen::Vector3d(8, 4, -2)}) {
    constexpr int n = 60;
    const Eigen::Vector3d step = (upper - lower) / n;
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) {
          const Eigen::Vector3d x = lower + step.cwiseProduct(Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5));
          sum += std::exp(-g.dot(x) - 0.5 * x.dot(A * x)) * step.prod();
        }
    EXPECT_NEAR(log_box_integral(g, A, lower, upper), std::log(sum), 0.05) << g.transpose();
  }
}

// The truncated integrals against sums, also where a bound cuts far into the tail.
TEST(LinearModel, TruncatedEvidence) {
  for (const double g : {-3.0, 0.0, 5.0, 60.0}) {
    double sum = 0;
    const double a = 2, step = 1e-4;
    for (int i = 0; i < 40000; ++i) sum += step * std::exp(-g * (0.5 + i) * step - 0.5 * a * std::pow((0.5 + i) * step, 2));
    EXPECT_NEAR(log_truncated_gaussian(g, a, 0, 4), std::log(sum), 1e-4) << g;
  }
  // Two bounded parameters and a free one: against the sum over both bounded ones.
  LinearModel model{Eigen::Vector4d(1, -2, 0.5, 1), Eigen::MatrixXd(4, 3), Eigen::Vector3d(0.3, -0.2, 0), Eigen::Vector2d(0, -1),
                    Eigen::Vector2d(2, 1)};
  model.J << 1, 0.5, 0.2, -0.3, 1, 0.1, 0.4, 0.2, -1, 0.6, -0.7, 0.3;
  double sum = 0, mass = 0;
  const int n = 300;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d d((i + 0.5) * 2 / n, -1 + (j + 0.5) * 2 / n);
      const Eigen::Vector4d r = model.rho + model.J.leftCols(2) * d, c = model.J.col(2);
      const double prior = std::exp(-0.5 * (d - model.prior.head(2)).squaredNorm()), a = 1 + c.squaredNorm();
      sum += prior * std::exp(-0.5 * r.squaredNorm() + 0.5 * std::pow(c.dot(r), 2) / a) / std::sqrt(a), mass += prior;
    }
  }
  EXPECT_NEAR(solve(model).log_evidence, std::log(sum / mass), 1e-3);
}
