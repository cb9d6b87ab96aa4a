#include "diagnosis/judgement/excess_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr int n_resamples = 600;
/// Share of experiments without a gap in which noise makes no larger excess than that which counts as none.
constexpr double sure = 0.95;
/// An excess is zero below this, in units of u_D^2 per row.
constexpr double rounding = 1e-12;

/// The errors without the noise that they hold already: as large as the excess says. Another realisation of the noise on top of errors that
/// hold one would count it twice, and the interval would come out too wide.
WithheldError without_noise(WithheldError gap) {
  double square = 0;
  Eigen::Index n = 0;
  for (const Eigen::VectorXd& error : gap.error) square += error.squaredNorm(), n += error.size();
  const double share = square > 0 ? excess_gap(gap) * static_cast<double>(n) / square : 0;
  for (Eigen::VectorXd& error : gap.error) error *= std::sqrt(share);
  return gap;
}

/// The excess before and after at these points with another strength within its posterior, and a realisation of noise and inputs for each
/// point (one that was drawn twice has two), the same before and after.
std::array<double, 2> drawn_excess(const WithheldError& before, const WithheldError& after, const std::vector<int>& points,
                                   NormalNumbers& random) {
  Eigen::VectorXd strength(after.strength_factor.cols());
  for (double& v : strength) v = random();
  strength = after.strength_factor * strength;
  double sum_before = 0, sum_after = 0;
  Eigen::Index n = 0;
  for (const int point : points) {
    const auto p = static_cast<std::size_t>(point);
    Eigen::VectorXd noise(after.error[p].size());
    for (double& v : noise) v = random();
    Eigen::VectorXd drawn = after.error[p] + after.noise[p] * noise;
    if (strength.size() > 0) drawn += after.by_strength[p] * strength;
    sum_after += drawn.squaredNorm() - after.covariance[p].trace();
    sum_before += (before.error[p] + before.noise[p] * noise).squaredNorm() - before.covariance[p].trace();
    n += noise.size();
  }
  const double count = static_cast<double>(n);
  return {std::max(0.0, sum_before / count), std::max(0.0, sum_after / count)};
}

}  // namespace

double excess_gap(const WithheldError& error) {
  double sum = 0;
  Eigen::Index n = 0;
  for (std::size_t p = 0; p < error.error.size(); ++p)
    sum += error.error[p].squaredNorm() - error.covariance[p].trace(), n += error.error[p].size();
  return n > 0 ? std::max(0.0, sum / static_cast<double>(n)) : 0;
}

double noise_floor(const WithheldError& error) {
  double sum = 0;
  Eigen::Index n = 0;
  for (std::size_t p = 0; p < error.error.size(); ++p) sum += error.covariance[p].trace(), n += error.error[p].size();
  return n > 0 ? sum / static_cast<double>(n) : 0;
}

double excess_of_noise(const WithheldError& error, std::uint64_t seed) {
  NormalNumbers random(seed + 19);
  WithheldError drawn = error;
  std::vector<double> excess;
  for (int k = 0; k < n_resamples; ++k) {
    for (std::size_t p = 0; p < error.error.size(); ++p) {
      Eigen::VectorXd noise(error.error[p].size());
      for (double& v : noise) v = random();
      drawn.error[p] = error.noise[p] * noise;
    }
    excess.push_back(excess_gap(drawn));
  }
  std::sort(excess.begin(), excess.end());
  return std::max(rounding, excess[static_cast<std::size_t>(sure * (n_resamples - 1))]);
}

Shrinkage shrinkage(const WithheldError& before, const WithheldError& after, std::uint64_t seed) {
  const double G_before = excess_gap(before);
  if (G_before <= excess_of_noise(before, seed)) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, none};
  }
  Shrinkage result;
  result.mean = 1 - excess_gap(after) / G_before;
  const WithheldError clean_before = without_noise(before), clean_after = without_noise(after);
  NormalNumbers random(seed + 17);
  std::vector<double> draws;
  const int n = static_cast<int>(before.error.size());
  for (int k = 0; k < n_resamples; ++k) {
    std::vector<int> points(before.error.size());
    for (int& p : points) p = random.index(n);
    const auto [own, left] = drawn_excess(clean_before, clean_after, points, random);
    if (own > rounding) draws.push_back(1 - left / own);
  }
  std::sort(draws.begin(), draws.end());
  if (draws.empty()) return {result.mean, result.mean, result.mean};
  result.low = std::min(result.mean, draws[static_cast<std::size_t>(0.025 * static_cast<double>(draws.size() - 1))]);
  result.high = std::max(result.mean, draws[static_cast<std::size_t>(0.975 * static_cast<double>(draws.size() - 1))]);
  return result;
}

}  // namespace snag
