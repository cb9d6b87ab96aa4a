#include <algorithm>
#include <cmath>

#include "diagnosis/data/summary.hpp"
#include "diagnosis/statistics/lifetimes.hpp"

namespace snag {

namespace {

double log_beta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

// log P(k of n) when m of N runs showed the event: beta-binomial.
double log_event(double k, double n, double fraction, int N) {
  const double a = fraction * N + 0.5, b = (1 - fraction) * N + 0.5;
  return log_beta(k + a, n - k + b) - log_beta(a, b);
}

// log P(sum over n tests) when N runs had this mean: negative binomial.
double log_count(double sum, double n, double mean, int N) {
  const double a = mean * N + 0.5;
  return std::lgamma(sum + a) - std::lgamma(a) + a * std::log(N / (N + n)) + sum * std::log(n / (N + n));
}

template <class LogLikelihood>
double signed_deviance(double measured, double model, double best, const LogLikelihood& log_likelihood) {
  return (measured >= model ? 1 : -1) * std::sqrt(std::max(0.0, 2 * (log_likelihood(best) - log_likelihood(model))));
}

// The mean at which a likelihood of the model's mean is largest, between two bounds.
template <class LogLikelihood>
double best_mean(double low, double high, const LogLikelihood& log_likelihood) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  for (int i = 0; i < 80; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    (log_likelihood(a) > log_likelihood(b) ? high : low) = log_likelihood(a) > log_likelihood(b) ? b : a;
  }
  return 0.5 * (low + high);
}

}  // namespace

double deviance_residual(const Row& row, double model, int n_runs, double scatter) {
  const double n = row.n_replicates;
  if (row.kind == Row::Kind::event) {
    const auto log_likelihood = [&](double p) { return log_event(row.value * n, n, p, n_runs); };
    return signed_deviance(row.value, model, best_mean(0, 1, log_likelihood), log_likelihood);
  }
  if (row.kind == Row::Kind::count) {
    const auto log_likelihood = [&](double mean) { return log_count(row.value * n / row.sigma, n, mean / row.sigma, n_runs); };
    return signed_deviance(row.value, model, best_mean(0, 2 * row.value + 1, log_likelihood), log_likelihood);
  }
  if (row.kind == Row::Kind::time) {
    const auto log_likelihood = [&](double median) { return log_likelihood_of_times(row.values, row.censored, median, row.sigma); };
    // Of times that are all censored the likelihood grows with the median up to 1.
    const double best = std::isfinite(row.u) ? row.value : std::numeric_limits<double>::infinity();
    return signed_deviance(best, model, best, log_likelihood) / std::sqrt(variance_ratio(row, model, n_runs, scatter));
  }
  // A variance over its expectation is chi2 over its degrees of freedom, far from normal where these are few.
  const double log_ratio = row.value - std::log(row.noise_u * row.noise_u + model);
  const double degrees = row.sigma / variance_ratio(row, model, n_runs, scatter);
  return (log_ratio >= 0 ? 1 : -1) * std::sqrt(degrees * std::max(0.0, std::expm1(log_ratio) - log_ratio));
}

double variance_ratio(const Row& row, double model, int n_runs, double scatter) {
  const double n = row.n_replicates;
  if (row.kind == Row::Kind::time) return 1 + scatter / n_runs / (row.sigma * row.sigma / n);
  if (row.kind != Row::Kind::spread) return 1;
  // The variance of the noise and that of the runs; paths of a random effect are correlated in time, so they count as few.
  const double share = model / (row.noise_u * row.noise_u + model);
  const double degrees = row.sigma * (1 - share) * (1 - share) + (n - 1) * share * (2 - share);
  const double u_runs = n_runs > 1 ? share * std::sqrt(2.0 / (n_runs - 1)) : 0;
  return (2 / std::max(degrees, 1.0) + u_runs * u_runs) * row.sigma / 2;
}

}  // namespace snag
