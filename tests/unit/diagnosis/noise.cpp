// Requirement: noise that is understated or lasts from sample to sample is found from the repeats, pooled over operating points; noise that
// is as stated, or a scatter that grows along the path, is not taken for it.
#include "diagnosis/data/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {
namespace {

constexpr double u = 2e-4, step = 0.035;

/// Three points with as many repeats of 20 samples: noise of a size and correlation from sample to sample, times 1 + growth t.
NoiseModel found(double factor, double correlation, double growth, std::uint64_t seed) {
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
  return noise_of_repeats(experiment).front();
}

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

TEST(Noise, LastsFromSampleToSample) {
  for (const double factor : {1.0, 2.0}) {
    const NoiseModel noise = found(factor, 0.8, 0, 8);
    EXPECT_NEAR(noise.factor, factor, 0.3 * factor);
    EXPECT_NEAR(noise.correlation(step), 0.8, 0.1);
  }
}

TEST(Noise, GrowingScatterIsNoNoise) { EXPECT_EQ(found(1, 0, 0.2, 9).factor, 1); }

}  // namespace
}  // namespace snag
