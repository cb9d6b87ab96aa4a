// timeout: 300
// cost: 4
// Requirement: noise that is understated or lasts from sample to sample is told with its factor and duration, not blamed on an effect and
// not called outside.
#include <gtest/gtest.h>

#include "tests/verification/diagnosis/formula.hpp"

using namespace snag;
using formula::judged;

namespace {

constexpr double noise = 5e-4;

}  // namespace

// Nulls whose noise is two and three times what is stated, and as stated but lasting over some samples: none, and the factor is told.
TEST(Noise, NullsWithAnotherNoise) {
  int none = 0, n = 0;
  for (int i = 0; i < 6; ++i, ++n) {
    const double factor = 2 + i % 2;
    Experiment experiment = formula::experiment({}, 6, 0, 4, factor * noise, 7000 + i);
    for (Observable& observable : experiment.observables) observable.noise_u = noise;
    const Verdict verdict = judged(experiment);
    none += verdict.verdict == VerdictKind::none;
    ASSERT_TRUE(verdict.noise.contains("x"));
    EXPECT_NEAR(verdict.noise.at("x").factor, factor, 0.2 * factor);
  }
  for (int i = 0; i < 6; ++i, ++n) {
    Experiment experiment = formula::experiment({}, 6, 0, 4, 1e-12, 7100 + i);
    NormalNumbers random(7200 + i);
    double e = 0;
    for (Datum& d : experiment.data) {
      e = d.time < 0.03 ? random() : 0.9 * e + std::sqrt(1 - 0.81) * random();
      d.value += noise * e;
    }
    for (Observable& observable : experiment.observables) observable.noise_u = noise;
    const Verdict verdict = judged(experiment);
    none += verdict.verdict == VerdictKind::none;
    EXPECT_GT(verdict.noise.at("z").correlation_time, 0.05);
  }
  std::printf("nulls with another noise: %d of %d none\n", none, n);
  EXPECT_GE(none, n - 1);
}
