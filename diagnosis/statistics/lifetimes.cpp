#include "diagnosis/statistics/lifetimes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

// phi(z)/(1 - Phi(z)): growth of the log-likelihood of a censored time with the mean.
double hazard(double z) {
  if (z > 8) return z + 1 / z;
  return std::exp(-0.5 * z * z) / 2.5066282746310002 / (1 - normal_cdf(z));
}

}  // namespace

double log_likelihood_of_times(const std::vector<double>& log_times, const std::vector<bool>& censored, double mean, double sigma) {
  double sum = 0;
  for (std::size_t i = 0; i < log_times.size(); ++i) {
    const double z = (log_times[i] - mean) / sigma;
    if (!censored[i])
      sum += -0.5 * z * z - std::log(sigma);
    else
      sum += z > 8 ? -0.5 * z * z - std::log(z * 2.5066282746310002) : std::log(0.5 * std::erfc(z / 1.4142135623730951));
  }
  return sum;
}

LogTimes fit_log_times(const std::vector<double>& log_times, const std::vector<bool>& censored, double minimum_sigma) {
  const double n = static_cast<double>(log_times.size());
  double known = 0, mean = 0, square = 0;
  for (const double t : log_times) mean += t / n;
  for (std::size_t i = 0; i < log_times.size(); ++i) known += !censored[i];
  constexpr double assumed_sigma = 0.5;
  if (known == 0) return {mean, std::max(minimum_sigma, assumed_sigma), std::numeric_limits<double>::infinity()};
  for (const double t : log_times) square += (t - mean) * (t - mean);
  double sigma =
      known < 2 ? std::max(minimum_sigma, assumed_sigma) : std::max({std::sqrt(square / std::max(1.0, n - 1)), minimum_sigma, 1e-9});
  // Expectation-maximisation: a censored time stands for its mean and variance beyond the censoring.
  for (int k = 0; k < 500; ++k) {
    double first = 0, second = 0;
    for (std::size_t i = 0; i < log_times.size(); ++i) {
      double expected = log_times[i], variance = 0;
      if (censored[i]) {
        const double z = (log_times[i] - mean) / sigma, h = hazard(z);
        expected = mean + sigma * h, variance = std::max(0.0, sigma * sigma * (1 + z * h - h * h));
      }
      first += expected, second += expected * expected + variance;
    }
    const double next = first / n, spread = second / n - next * next;
    const double change = std::abs(next - mean);
    mean = next;
    if (known >= 2) sigma = std::max({std::sqrt(std::max(0.0, spread) * n / std::max(1.0, n - 1)), minimum_sigma, 1e-9});
    if (change < 1e-10 * (sigma + std::abs(mean))) break;
  }
  double information = 0;
  for (std::size_t i = 0; i < log_times.size(); ++i) {
    const double z = (log_times[i] - mean) / sigma, h = censored[i] ? hazard(z) : 0;
    information += (censored[i] ? h * (h - z) : 1) / (sigma * sigma);
  }
  return {mean, sigma, 1 / std::sqrt(information)};
}

}  // namespace snag
