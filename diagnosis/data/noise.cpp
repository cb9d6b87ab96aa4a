#include "diagnosis/data/noise.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "diagnosis/data/summary.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr double nats_wanted = 6;
constexpr int n_factors = 185, n_times = 16;
constexpr double smallest_factor = 1e-4, largest_factor = 10;

/// Series of the differences between repeats at one point, with the variance of the noise, and their times.
struct Contrasts {
  std::vector<double> times;
  std::vector<std::vector<double>> series;  // [R - 1][time], over u
};

/// Helmert's contrasts of the repeats at the times that all of them have; repeats with less than half of the times of the longest one are
/// left aside, so that one that ended early does not end them all.
Contrasts contrasts_of(const std::map<int, std::map<double, double>>& repeats, double u) {
  Contrasts result;
  std::size_t most = 0;
  for (const auto& [replicate, values] : repeats) most = std::max(most, values.size());
  std::vector<const std::map<double, double>*> used;
  for (const auto& [replicate, values] : repeats)
    if (2 * values.size() >= most) used.push_back(&values);
  for (const auto& [time, value] : *used.front())
    if (std::all_of(used.begin(), used.end(), [&, t = time](const auto* values) { return values->contains(t); }))
      result.times.push_back(time);
  std::vector<std::vector<double>> complete;
  for (const auto* values : used) {
    complete.emplace_back();
    for (const double time : result.times) complete.back().push_back(values->at(time));
  }
  for (std::size_t r = 1; r < complete.size(); ++r) {
    result.series.emplace_back();
    const auto n = static_cast<double>(r);
    for (std::size_t k = 0; k < result.times.size(); ++k) {
      double mean = 0;
      for (std::size_t before = 0; before < r; ++before) mean += complete[before][k] / n;
      result.series.back().push_back((complete[r][k] - mean) / u * std::sqrt(n / (n + 1)));
    }
  }
  return result;
}

/// Sums of the likelihood of a correlation time: log L = -n ln F - 1/2 S/F^2 - 1/2 log_determinant + const.
struct Sums {
  double n = 0, S = 0, log_determinant = 0;
  double log_likelihood(double factor) const { return -n * std::log(factor) - 0.5 * S / (factor * factor) - 0.5 * log_determinant; }
};

Sums sums_of(const std::vector<Contrasts>& all, double correlation_time) {
  Sums sums;
  for (const Contrasts& point : all)
    for (const auto& series : point.series)
      for (std::size_t k = 0; k < series.size(); ++k) {
        const double a = k > 0 && correlation_time > 0 ? std::exp(-(point.times[k] - point.times[k - 1]) / correlation_time) : 0;
        const double rest = 1 - a * a, e = series[k] - (k > 0 ? a * series[k - 1] : 0);
        sums.n += 1, sums.S += e * e / rest, sums.log_determinant += std::log(rest);
      }
  return sums;
}

double factor_at(int i) { return smallest_factor * std::pow(largest_factor / smallest_factor, static_cast<double>(i) / (n_factors - 1)); }

/// Whether the scatter is as large in the last third of the paths as in the first.
bool is_stationary(const std::vector<Contrasts>& all, double correlation_time) {
  double first = 0, last = 0, n = 0;
  for (const Contrasts& point : all)
    for (const auto& series : point.series) {
      const std::size_t third = series.size() / 3;
      if (third == 0) continue;
      for (std::size_t k = 0; k < third; ++k) first += std::pow(series[k], 2), last += std::pow(series[series.size() - 1 - k], 2);
      const double step = (point.times.back() - point.times.front()) / static_cast<double>(series.size() - 1);
      const double a = correlation_time > 0 ? std::exp(-step / correlation_time) : 0;
      n += std::max(1.0, static_cast<double>(third) * (1 - a * a) / (1 + a * a));
    }
  if (n == 0 || first <= 0 || last <= 0) return n == 0;
  constexpr double unlike = 3.3;  // of the logarithm of the ratio, whose standard deviation is about 2/sqrt(n): p = 0.001
  return std::abs(std::log(last / first)) < unlike * 2 / std::sqrt(n);
}

NoiseModel noise_of(const std::vector<Contrasts>& all) {
  double shortest = 0, longest = 0;
  for (const Contrasts& point : all) {
    const double duration = point.times.back() - point.times.front(), step = duration / static_cast<double>(point.times.size() - 1);
    if (shortest == 0 || 0.5 * step < shortest) shortest = 0.5 * step;
    longest = std::max(longest, duration);
  }
  const double as_stated = sums_of(all, 0).log_likelihood(1);
  struct Choice {
    std::vector<double> gains{};  // over what is stated
    double most = -std::numeric_limits<double>::infinity();
    NoiseModel noise{};
    double log_mean() const { return log_sum_exp(gains) - std::log(static_cast<double>(gains.size())); }
  };
  Choice independent, correlated;
  for (int t = 0; t <= n_times; ++t) {
    Choice& choice = t == 0 ? independent : correlated;
    const double time = t == 0 ? 0 : shortest * std::pow(longest / shortest, (t - 1.0) / (n_times - 1));
    const Sums sums = sums_of(all, time);
    for (int i = 0; i < n_factors; ++i) {
      choice.gains.push_back(sums.log_likelihood(factor_at(i)) - as_stated);
      if (choice.gains.back() > choice.most) choice.most = choice.gains.back(), choice.noise = {factor_at(i), time};
    }
  }
  const bool lasts = correlated.log_mean() > independent.log_mean() + nats_wanted;
  NoiseModel found = lasts ? correlated.noise : independent.noise;
  // Repeats that scatter as much as the grid goes, or more, do not show a noise that was understated: more likely the numbers have another
  // unit, whose hypothesis brings the noise along (mistakes.hpp). Their scatter is left to summary.hpp.
  if (const Sums all_together = sums_of(all, 0); found.factor >= factor_at(n_factors - 1))
    return {.scatter = std::sqrt(all_together.S / all_together.n)};
  // Who states more than the repeats scatter knows of more than these.
  found.factor = std::max(1.0, found.factor);
  found.nats = log_sum_exp(std::array{independent.log_mean(), correlated.log_mean()}) - std::numbers::ln2;
  const bool another = lasts || found.factor > 1;
  return another && found.nats > nats_wanted && is_stationary(all, found.correlation_time) ? found : NoiseModel{};
}

}  // namespace

double NoiseModel::correlation(double apart) const {
  if (apart == 0) return 1;
  return correlation_time > 0 ? std::exp(-std::abs(apart) / correlation_time) : 0;
}

std::vector<NoiseModel> noise_of_repeats(const Experiment& experiment) {
  std::vector<NoiseModel> all(experiment.observables.size());
  // [observable][point][replicate][time]
  std::vector<std::map<int, std::map<int, std::map<double, double>>>> samples(all.size());
  for (const Datum& d : experiment.data) {
    const Observable& observable = experiment.observables[static_cast<std::size_t>(d.observable)];
    if (experiment.points[static_cast<std::size_t>(d.point)].withheld || std::isnan(d.time) || observable.noise_u == 0 || d.n > 1) continue;
    auto& path = samples[static_cast<std::size_t>(d.observable)][d.point];
    double value = observable.kind == Observable::Kind::lognormal ? std::log(d.value) : d.value;
    if (const auto first = path.begin(); observable.kind == Observable::Kind::angle && first != path.end())
      if (const auto at = first->second.find(d.time); at != first->second.end())
        value = at->second + wrapped(value - at->second, angle_period(observable));
    path[d.replicate][d.time] = value;
  }
  for (std::size_t o = 0; o < all.size(); ++o) {
    std::vector<Contrasts> points;
    for (const auto& [point, repeats] : samples[o]) {
      Contrasts contrasts = contrasts_of(repeats, experiment.observables[o].noise_u);
      if (contrasts.times.size() > 1 && !contrasts.series.empty()) points.push_back(std::move(contrasts));
    }
    if (!points.empty()) all[o] = noise_of(points);
  }
  return all;
}

}  // namespace snag
