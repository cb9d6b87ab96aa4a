// Analysis of variance and independent samples, against cases whose numbers have a closed form.
#include "observe/anova.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "observe/independent_samples.hpp"

using namespace snag;

// Measured rags in the suction pipe: nine operating points (Jensen 2018, Tables A.1, A.3).
namespace suction_pipe {
const std::vector<double> rags{286, 196, 207, 265, 116, 241, 337, 241, 234};
const std::vector<double> area{0.0147, 0.0126, 0.0123, 0.0134, 0.0131, 0.0111, 0.0140, 0.0119, 0.0114};
const std::vector<double> area_sigma{0.00398, 0.00334, 0.00336, 0.00372, 0.00347, 0.00321, 0.00422, 0.00301, 0.00418};
const std::vector<double> elongation{2.60, 2.70, 2.88, 2.64, 2.73, 2.69, 2.72, 2.53, 2.53};
const std::vector<double> elongation_sigma{1.12, 1.15, 1.17, 1.16, 1.15, 1.29, 1.18, 1.08, 1.06};
const std::vector<double> orientation{5.92, 6.19, 4.57, 4.75, 5.97, 8.71, 8.14, 6.92, 8.26};
const std::vector<double> orientation_sigma{21.0, 24.0, 20.9, 23.7, 23.5, 26.5, 18.5, 27.7, 22.66};
const std::vector<double> y{2.27, -0.002, 8.68, -3.81, -2.08, -4.70, -2.06, -0.72, -2.36};
const std::vector<double> y_sigma{32.2, 34.3, 34.5, 33.8, 32.4, 35.4, 31.0, 32.3, 34.5};
}  // namespace suction_pipe

namespace {

/// p of the analysis if only a share of each count is independent.
double p_of_share(const std::vector<double>& means, const std::vector<double>& deviations, std::vector<double> counts, double share) {
  for (double& n : counts) n *= share;
  return anova(means, deviations, counts).p;
}

/// The share of each count that must be independent for the analysis to give this p.
double independent_share(const std::vector<double>& means, const std::vector<double>& deviations, const std::vector<double>& counts,
                         double p) {
  double low = 0.02, high = 1;
  if (p_of_share(means, deviations, counts, high) > p) return 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (p_of_share(means, deviations, counts, middle) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

// The printed means, deviations and counts do not give the printed p; they do when only a part of the rags is independent.
TEST(Anova, SuctionPipe) {
  using namespace suction_pipe;
  EXPECT_NEAR(std::log10(anova(area, area_sigma, rags).p), std::log10(1.7e-41), 0.1);
  EXPECT_NEAR(anova(elongation, elongation_sigma, rags).p, 0.041, 0.001);
  EXPECT_NEAR(anova(orientation, orientation_sigma, rags).p, 0.39, 0.005);
  EXPECT_NEAR(anova(y, y_sigma, rags).p, 0.0011, 0.0001);
  EXPECT_NEAR(independent_share(area, area_sigma, rags, 4.80e-10), 0.28, 0.01);
  EXPECT_NEAR(independent_share(elongation, elongation_sigma, rags, 0.489), 0.46, 0.01);
  EXPECT_NEAR(independent_share(orientation, orientation_sigma, rags, 0.752), 0.60, 0.01);
  EXPECT_NEAR(independent_share(y, y_sigma, rags, 0.0971), 0.52, 0.01);
}

// Textbook: {6 8 4 5 3 4}, {8 12 9 11 6 8}, {13 9 11 8 7 12}: F = (84/2)/(68/15) = 9.265, p = 0.0024;
// with two degrees of freedom between the groups p = (1 + 2 F/d)^(-d/2).
TEST(Anova, Textbook) {
  const std::array means{5.0, 9.0, 10.0}, deviations{std::sqrt(16.0 / 5), std::sqrt(24.0 / 5), std::sqrt(28.0 / 5)}, counts{6.0, 6.0, 6.0};
  const Anova test = anova(means, deviations, counts);
  EXPECT_NEAR(test.F, 42 / (68.0 / 15), 1e-12);
  EXPECT_NEAR(test.p, std::pow(1 + 2 * test.F / 15, -7.5), 1e-14);
  EXPECT_NEAR(test.p, 0.0024, 5e-5);
}

// Five groups: with four degrees of freedom between them p = x^a (1 + a (1 - x)), a = d/2, x = d/(d + 4 F). Unequal counts, not whole.
TEST(Anova, FiveUnequalGroups) {
  const std::array means{1.0, 2.0, 3.0, 2.5, 1.5}, deviations{1.0, 1.5, 1.2, 0.8, 1.1}, counts{4.5, 7.0, 3.25, 6.0, 5.25};
  const Anova test = anova(means, deviations, counts);
  const double d = 26 - 5, grand = (4.5 * 1 + 7 * 2 + 3.25 * 3 + 6 * 2.5 + 5.25 * 1.5) / 26;
  double between = 0, within = 0;
  for (int g = 0; g < 5; ++g)
    between += counts[g] * std::pow(means[g] - grand, 2), within += (counts[g] - 1) * deviations[g] * deviations[g];
  EXPECT_NEAR(test.F, (between / 4) / (within / d), 1e-12);
  const double a = d / 2, x = d / (d + 4 * test.F);
  EXPECT_NEAR(test.p, std::pow(x, a) * (1 + a * (1 - x)), 1e-14);
}

// Two groups of two rags seen twice: B = 52/2, W = 8/4, rho = 24/28; m' = 2, so that four samples are worth 4/(1 + 6/7) = 28/13.
TEST(IndependentSamples, PassesOfTheSameRag) {
  const std::vector<RagSample> samples{{0, 0, 1}, {0, 0, 3}, {0, 1, 5}, {0, 1, 7}, {1, 0, 2}, {1, 0, 4}, {1, 1, 8}, {1, 1, 10}};
  const IndependentSamples found = independent_samples(samples, 2);
  EXPECT_EQ(found.dependence, Dependence::intraclass);
  EXPECT_NEAR(found.correlation, 6.0 / 7, 1e-12);
  for (const double n : found.counts) EXPECT_NEAR(n, 28.0 / 13, 1e-12);
}

// Rags that always look the same are worth one sample each; with unequal passes n^2/sum m^2.
TEST(IndependentSamples, RagsThatDoNotChange) {
  const std::vector<RagSample> samples{{0, 7, 1}, {0, 7, 1}, {0, 9, 3}, {0, 9, 3}, {1, 7, 2}, {1, 7, 2}, {1, 7, 2}, {1, 8, 5}};
  const IndependentSamples found = independent_samples(samples, 2);
  EXPECT_NEAR(found.correlation, 1, 1e-12);
  EXPECT_NEAR(found.counts[0], 2, 1e-12);
  EXPECT_NEAR(found.counts[1], 16.0 / 10, 1e-12);
}

// Rags that differ less than their passes do count in full; so do rags seen once.
TEST(IndependentSamples, NothingIsCountedTwiceInFavour) {
  const std::vector<RagSample> alike{{0, 0, 1}, {0, 0, 3}, {0, 1, 3}, {0, 1, 1}};
  EXPECT_LT(independent_samples(alike, 1).correlation, 0);
  EXPECT_EQ(independent_samples(alike, 1).counts[0], 4);
  const std::vector<RagSample> once{{0, 0, 1}, {0, 1, 3}, {0, 2, 4}};
  EXPECT_EQ(independent_samples(once, 1).dependence, Dependence::none);
  EXPECT_EQ(independent_samples(once, 1).counts[0], 3);
}

// Axes at 80, -80 of one rag and 0, 20 of another, as vectors of the doubled angle: two rags that differ, though 80 and -80 look far apart.
// Within a rag half of |e(a) - e(b)|^2 = 1 - cos 2(a - b) = 1 - cos 40; between their means e(90) and e(10) times cos 20: cos^2 20 (1 - cos
// 160).
TEST(IndependentSamples, AxesDoNotWrap) {
  const auto axis = [](int rag, double angle) {
    const double twice = angle * std::numbers::pi / 90;
    return RagSample{0, rag, {std::cos(twice), std::sin(twice)}};
  };
  const auto cosine = [](double angle) { return std::cos(angle * std::numbers::pi / 180); };
  const IndependentSamples found = independent_samples(std::vector{axis(0, 80), axis(0, -80), axis(1, 0), axis(1, 20)}, 1);
  const double W = 1 - cosine(40), B = 2 * cosine(20) * cosine(20) * (1 - cosine(160));
  EXPECT_NEAR(found.correlation, (B - W) / (B + W), 1e-12);
  EXPECT_NEAR(found.counts[0], 4 / (1 + found.correlation), 1e-12);
  EXPECT_GT(found.correlation, 0.8);
}

// A row 1 2 3 4: r = 1.25/5, n_eff = 4 (1 - r)/(1 + r) = 2.4. A row that alternates counts in full.
TEST(IndependentSamples, NeighboursInTime) {
  const std::vector<RagSample> rising{{0, -1, 1}, {0, -1, 2}, {0, -1, 3}, {0, -1, 4}};
  const IndependentSamples found = independent_samples(rising, 1);
  EXPECT_EQ(found.dependence, Dependence::autocorrelation);
  EXPECT_NEAR(found.correlation, 0.25, 1e-12);
  EXPECT_NEAR(found.counts[0], 2.4, 1e-12);
  const std::vector<RagSample> alternating{{0, 4, 1}, {0, 4, -1}, {0, 4, 1}, {0, 4, -1}};  // one rag, known
  EXPECT_NEAR(independent_samples(alternating, 1).correlation, -0.75, 1e-12);
  EXPECT_EQ(independent_samples(alternating, 1).counts[0], 4);
}
