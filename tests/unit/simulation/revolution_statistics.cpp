// Statistics over revolutions against signals whose means, harmonics and noise are known.
#include "simulation/output/revolution_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace {

using namespace snag;

constexpr double pi = std::numbers::pi, degree = pi / 180;

/// 5 m, harmonics of 1, 0.3 and 0.1 m with crests at 40, 70 and -20 degrees, a vane count's worth of a higher one.
double head(double angle) {
  return 5 + std::cos(angle - 40 * degree) + 0.3 * std::cos(2 * (angle - 70 * degree)) + 0.1 * std::cos(3 * (angle + 20 * degree)) +
         0.05 * std::cos(17 * angle);
}

std::vector<Revolution> sampled(double step, double turned, const std::function<double(double)>& signal, double start = 0) {
  RevolutionSampler sampler(start);
  std::vector<Revolution> all;
  for (int i = 1; std::abs((i - 1) * step) < turned - 1e-9; ++i)
    for (const Revolution& one : sampler.add(i * step, {signal(start + i * step), i * step})) all.push_back(one);
  return all;
}

void expect_head(const Revolution& revolution) {
  EXPECT_NEAR(revolution_mean(revolution, 0), 5, 1e-3);
  const Spectrum spectrum = revolution_spectrum(revolution, 0);
  ASSERT_EQ(spectrum.harmonics.size(), 20u);
  const double amplitudes[] = {1, 0.3, 0.1}, phases[] = {40 * degree, 140 * degree, -60 * degree};
  for (int n = 0; n < 3; ++n) {
    EXPECT_NEAR(spectrum.harmonics[n].amplitude, amplitudes[n], 1e-9);
    EXPECT_NEAR(spectrum.harmonics[n].phase, phases[n], 1e-8);
  }
  EXPECT_NEAR(spectrum.harmonics[3].amplitude, 0, 1e-9);
  EXPECT_NEAR(spectrum.harmonics[16].amplitude, 0.05, 1e-9);
  EXPECT_NEAR(spectrum.noise, 0, 1e-9);
}

// Steps that divide a revolution, and steps that do not; a rotor that starts at an angle; one that turns the other way.
TEST(RevolutionStatistics, KnownHarmonicsAreFound) {
  for (const double step : {0.72, 1.44, 1.7, 2.3456})
    for (const double start : {0.0, 33.3})
      for (const double sense : {1.0, -1.0}) {
        SCOPED_TRACE(testing::Message() << step << " degrees, from " << start << ", sense " << sense);
        const auto revolutions = sampled(sense * step * degree, 4 * 2 * pi, head, start * degree);
        ASSERT_GE(revolutions.size(), 3u);
        for (std::size_t i = 1; i < revolutions.size(); ++i) expect_head(revolutions[i]);
      }
}

// Each revolution begins and ends at a whole number of turns; a signal that rises with the angle shows it.
TEST(RevolutionStatistics, RevolutionsTileTheTurning) {
  const auto revolutions = sampled(0.1, 5 * 2 * pi, [](double angle) { return angle; });
  ASSERT_EQ(revolutions.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(revolutions[i].number, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(revolutions[i].turned.front(), 0);
    EXPECT_EQ(revolutions[i].turned.back(), 1);
    // of the first one the stretch before the first sample is like it: 0.1 wide and half as high too much
    const double exact = 2 * pi * (static_cast<double>(i) + 0.5) + (i == 0 ? 0.5 * 0.1 * 0.1 / (2 * pi) : 0);
    EXPECT_NEAR(revolution_mean(revolutions[i], 1), exact, 1e-12 * exact);
    EXPECT_NEAR(revolution_extremes(revolutions[i], 1).lowest, 2 * pi * static_cast<double>(i), 0.1 + 1e-9);
    EXPECT_GT(revolution_extremes(revolutions[i], 1).lowest, 2 * pi * static_cast<double>(i));
    EXPECT_NEAR(revolution_extremes(revolutions[i], 1).highest, 2 * pi * static_cast<double>(i + 1), 0.1);
  }
}

// 1000 steps of exactly a thousandth, added up with round-off: the sample at the end closes its revolution, no other does.
TEST(RevolutionStatistics, SampleAtTheEndClosesTheRevolution) {
  RevolutionSampler sampler;
  double turned = 0;
  for (int i = 1; i <= 10000; ++i) {
    turned += 2 * pi / 1000;
    const auto complete = sampler.add(turned, {1.0 * i});
    ASSERT_EQ(complete.size(), i % 1000 == 0 ? 1u : 0u) << i;
    if (complete.empty()) continue;
    EXPECT_EQ(complete[0].turned.size(), 1001u);
    EXPECT_EQ(complete[0].values.back()[0], i);
    EXPECT_TRUE(complete[0].ends_with_sample);
  }
}

// White noise of known strength: less what 41 fitted numbers take of it; harmonics are hardly touched by it.
TEST(RevolutionStatistics, NoiseIsWhatHarmonicsLeave) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 0.2);
  constexpr int n_steps = 2000;
  const auto revolutions = sampled(2 * pi / n_steps, 3 * 2 * pi, [&](double angle) { return head(angle) + normal(random); });
  for (const Revolution& one : revolutions) {
    const Spectrum spectrum = revolution_spectrum(one, 0);
    EXPECT_NEAR(spectrum.noise, 0.2 * std::sqrt(1 - 41.0 / n_steps), 0.2 * 5 / std::sqrt(2 * n_steps));
    EXPECT_NEAR(spectrum.harmonics[0].amplitude, 1, 5 * 0.2 * std::sqrt(2.0 / n_steps));
  }
  // A saw of the shaft's 25th multiple is noise too: A/sqrt(2).
  const auto fast = sampled(0.7 * degree, 2 * 2 * pi, [](double angle) { return head(angle) + 0.4 * std::cos(25 * angle); });
  EXPECT_NEAR(revolution_spectrum(fast[1], 0).noise, 0.4 / std::sqrt(2), 1e-3);
}

// Few samples: only as many harmonics as they resolve; none for a shaft that stands.
TEST(RevolutionStatistics, FewSamplesGiveFewHarmonics) {
  const auto revolutions = sampled(30 * degree, 2 * 2 * pi, [](double angle) { return 2 + std::cos(angle - 1); });
  const Spectrum spectrum = revolution_spectrum(revolutions[1], 0);
  ASSERT_EQ(spectrum.harmonics.size(), 3u);
  EXPECT_NEAR(spectrum.harmonics[0].amplitude, 1, 1e-12);
  EXPECT_NEAR(spectrum.harmonics[0].phase, 1, 1e-12);
  RevolutionSampler standing;
  EXPECT_TRUE(standing.add(0, {3}).empty());
  EXPECT_TRUE(standing.add(0, {6}).empty());
  EXPECT_NEAR(revolution_mean(standing.current(), 0), 4, 1e-12) << "the first value counts from the start";
}

// A signal with a part that repeats and one that alternates from revolution to revolution: mean and standard deviation of each bin.
TEST(RevolutionStatistics, PhaseAverageSeparatesWhatRepeats) {
  PhaseAverage average(72, 1);
  const auto revolutions = sampled(1.7 * degree, 5 * 2 * pi, [](double angle) {
    const bool is_odd = static_cast<int>(angle / (2 * pi)) % 2 == 1;
    return head(angle) + (is_odd ? 0.1 : -0.1) * (1 - std::cos(angle));
  });
  ASSERT_EQ(revolutions.size(), 5u);
  for (std::size_t i = 1; i < 5; ++i) average.add(revolutions[i], {0});
  EXPECT_EQ(average.n_revolutions(), 4);
  for (std::size_t bin = 0; bin < 72; ++bin) {
    EXPECT_NEAR(average.angle(bin), (5.0 * static_cast<double>(bin) + 2.5) * degree, 1e-12);
    double mean = 0;  // of the exact signal over the bin
    for (int k = 0; k < 100; ++k) mean += head((5.0 * static_cast<double>(bin) + 0.05 * (k + 0.5)) * degree) / 100;
    EXPECT_NEAR(average.mean(bin, 0), mean, 3e-3) << "linear pieces of 1.7 degrees under the 17th harmonic";
    EXPECT_NEAR(average.deviation(bin, 0), 0.1 * (1 - std::cos(average.angle(bin))) * std::sqrt(4.0 / 3), 1e-3);
  }
}

// Saved and restored in the middle of a revolution: the same to the bit.
TEST(RevolutionStatistics, ResumesToTheBit) {
  RevolutionSampler whole(0.3), first(0.3), second(0.3);
  PhaseAverage average(72, 2), resumed(72, 2);
  int n_complete = 0;
  for (int i = 1; i <= 1000; ++i) {
    const std::vector<double> values{head(0.031 * i), std::sin(0.5 * i)};
    const auto expected = whole.add(-0.031 * i, values);
    const auto found = (i <= 500 ? first : second).add(-0.031 * i, values);
    if (i == 500) second.restore(first.state());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k, ++n_complete) {
      EXPECT_EQ(found[k].number, expected[k].number);
      EXPECT_EQ(revolution_mean(found[k], 0), revolution_mean(expected[k], 0));
      EXPECT_EQ(revolution_spectrum(found[k], 1).noise, revolution_spectrum(expected[k], 1).noise);
      average.add(expected[k], {0, 1});
      PhaseAverage copy(72, 2);
      copy.restore(resumed.state());
      copy.add(found[k], {0, 1});
      resumed.restore(copy.state());
    }
  }
  EXPECT_EQ(n_complete, 4);
  EXPECT_EQ(average.state(), resumed.state());
}

}  // namespace
