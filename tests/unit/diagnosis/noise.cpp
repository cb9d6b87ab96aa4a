// Requirement: noise that is understated or lasts from sample to sample is found from the repeats, pooled over operating points; noise that
// is as stated, or a scatter that grows along the path, is not taken for it.
#include "diagnosis/data/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/data/summary.hpp"
#include "diagnosis/fitting/response.hpp"
#include "tests/verification/diagnosis/test_simulator.hpp"

namespace snag {
namespace {

constexpr double u = 2e-4, step = 0.035;

/// Three points with five repeats of 20 samples: noise of a size and correlation from sample to sample, times 1 + growth t.
Experiment experiment_of(double factor, double correlation, double growth, std::uint64_t seed) {
  Experiment experiment;
  experiment.observables = {{.id = "z", .unit = "m", .noise_u = u, .calibration_group = ""}};
  NormalNumbers random(seed);
  for (int p = 0; p < 3; ++p) {
    experiment.points.push_back({.id = std::string(1, static_cast<char>('A' + p)), .case_file = {}});
    for (int r = 0; r < 5; ++r) {
      double e = random();
      for (int k = 0; k < 20; ++k) {
        experiment.data.push_back({p, 0, r, step * (k + 1), std::sin(k) + u * factor * e * (1 + growth * k)});
        e = correlation * e + std::sqrt(1 - correlation * correlation) * random();
      }
    }
  }
  return experiment;
}

NoiseModel found(double factor, double correlation, double growth, std::uint64_t seed) {
  return noise_of_repeats(experiment_of(factor, correlation, growth, seed)).front();
}

/// Answers with the path of the experiment at the times of the samples; an effect by chance makes the spread between repeats a row.
class AtSamples final : public TestSimulator {
 public:
  AtSamples() {
    effects_ = {{.name = "eddies", .random = true}};
    for (int k = 0; k < 20; ++k) slots_.push_back({0, step * (k + 1)});
  }

 private:
  std::vector<double> values(const RunRequest&, NormalNumbers&) const override {
    std::vector<double> path;
    for (int k = 0; k < 20; ++k) path.push_back(std::sin(k));
    return path;
  }
};

TEST(Noise, AsStated) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const NoiseModel noise = found(1, 0, 0, seed);
    EXPECT_EQ(noise.factor, 1) << seed;
    EXPECT_EQ(noise.correlation_time, 0) << seed;
  }
}

TEST(Noise, Understated) {
  for (const double factor : {2.0, 3.0}) {
    const NoiseModel noise = found(factor, 0, 0, 7);
    EXPECT_NEAR(noise.factor, factor, 0.15 * factor);
    EXPECT_LT(noise.correlation(step), 0.2);
    EXPECT_GT(noise.nats, 6);
  }
}

TEST(Noise, Overstated) {
  for (const double factor : {0.6, 1e-3}) {
    const NoiseModel noise = found(factor, 0, 0, 7);
    EXPECT_EQ(noise.factor, 1) << factor;
    EXPECT_EQ(noise.correlation_time, 0) << factor;
  }
}

/// Numbers in another unit scatter a thousand times as much.
TEST(Noise, AnotherUnitIsNoNoise) {
  EXPECT_EQ(found(1000, 0, 0, 7).factor, 1);
  EXPECT_NEAR(found(1000, 0, 0, 7).scatter, 1000, 100);
  EXPECT_EQ(found(3, 0, 0, 7).scatter, 0);
  EXPECT_EQ(found(1000, 0.8, 0, 7).factor, 1);
}

TEST(Noise, LastsFromSampleToSample) {
  for (const double factor : {1.0, 2.0}) {
    const NoiseModel noise = found(factor, 0.8, 0, 8);
    EXPECT_NEAR(noise.factor, factor, 0.3 * factor);
    EXPECT_NEAR(noise.correlation(step), 0.8, 0.1);
  }
}

/// The spread between repeats in a part of the time is as far from its expectation as its row says, whether or not the noise lasts: samples
/// that are correlated are fewer independent ones.
TEST(Noise, SpreadIsAsUncertainAsItsRowSays) {
  for (const double correlation : {0.0, 0.8}) {
    double square = 0;
    int n = 0;
    for (std::uint64_t seed = 100; seed < 140; ++seed) {
      for (const PointSummary& point : summarize(experiment_of(1, correlation, 0, seed), AtSamples(), true)) {
        for (const Row& row : point.rows) {
          if (row.kind != Row::Kind::spread) continue;
          square += std::pow(deviance_residual(row, 0, 1, 0), 2), ++n;
        }
      }
    }
    ASSERT_EQ(n, 40 * 3 * 3);
    std::printf("correlation %.1f: mean square of %d deviations %.2f\n", correlation, n, square / n);
    EXPECT_NEAR(square / n, 1, 0.25) << correlation;  // 3 standard deviations of that mean are 0.22
  }
}

/// Under the mistake of a unit the spread between repeats is that of the noise in the other unit.
TEST(Noise, SpreadFollowsTheUnit) {
  Experiment experiment = experiment_of(1, 0, 0, 7);
  for (Datum& datum : experiment.data) datum.value *= 1000;
  AtSamples simulator;
  Responses responses(experiment, simulator);
  const auto& effects = responses.effects();
  const auto unit = std::find_if(effects.begin(), effects.end(), [](const Effect& effect) { return effect.name == "unit:m"; });
  ASSERT_NE(unit, effects.end());
  State state = responses.base();
  state.effects = {{static_cast<int>(unit - effects.begin()), 1}};
  const auto largest_of_spreads = [&](const State& of) {
    const Response answer = responses.run(of, {0}).front();
    const PointSummary& point = responses.points().front();
    const Eigen::LLT<Eigen::MatrixXd> unscaled(Eigen::MatrixXd::Identity(point.n_gaussian, point.n_gaussian));
    return residual(point, answer, unscaled).tail(3).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(largest_of_spreads(responses.base()), 100);
  EXPECT_LT(largest_of_spreads(state), 4);
}

TEST(Noise, GrowingScatterIsNoNoise) { EXPECT_EQ(found(1, 0, 0.2, 9).factor, 1); }

}  // namespace
}  // namespace snag
