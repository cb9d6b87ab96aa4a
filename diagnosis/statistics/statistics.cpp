#include "diagnosis/statistics/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/hypergeometric.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace snag {

namespace bm = boost::math;

double NormalNumbers::uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

double NormalNumbers::operator()() {
  const double radius = std::sqrt(-2 * std::log1p(-uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

double log_sum_exp(std::span<const double> values) {
  const double largest = *std::max_element(values.begin(), values.end());
  if (!std::isfinite(largest)) return largest;
  double sum = 0;
  for (const double v : values) sum += std::exp(v - largest);
  return largest + std::log(sum);
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }
double normal_quantile(double p) { return -std::numbers::sqrt2 * bm::erfc_inv(2 * p); }
double even_normal_deviate(std::uint64_t seed) {
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;  // 2^64 (sqrt(5) - 1)/2
  return normal_quantile((static_cast<double>((seed * golden) >> 11) + 0.5) * 0x1p-53);
}

double two_sided_p(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }

double score_of_p(double p) {
  constexpr double smallest = 1e-300;
  return p >= 1 ? 0 : std::numbers::sqrt2 * bm::erfc_inv(std::max(p, smallest));
}

double chi_squared_tail(double value, double n) {
  if (n <= 0 || value <= 0) return 1;
  return std::isfinite(value) ? bm::cdf(bm::complement(bm::chi_squared(n), value)) : 0;
}

std::array<double, 2> clopper_pearson(int k, int n, double level) {
  const double a = (1 - level) / 2;
  return {k == 0 ? 0 : bm::quantile(bm::beta_distribution<>(k, n - k + 1), a),
          k == n ? 1 : bm::quantile(bm::beta_distribution<>(k + 1, n - k), 1 - a)};
}

double fisher_exact(int k1, int n1, int k2, int n2) {
  const int k = k1 + k2, n = n1 + n2;
  if (n1 == 0 || n2 == 0 || k == 0 || k == n) return 1;
  const bm::hypergeometric law(k, n1, n);
  const double own = bm::pdf(law, k1);
  double p = 0;
  for (int i = std::max(0, k - n2); i <= std::min(k, n1); ++i) {
    const double term = bm::pdf(law, i);
    if (term <= own * (1 + 1e-7)) p += term;
  }
  return std::min(1.0, p);
}

double equal_rates(double sum1, int n1, double sum2, int n2, double overdispersion) {
  const double phi = std::max(1.0, overdispersion), first = std::round(sum1 / phi), total = first + std::round(sum2 / phi);
  if (n1 == 0 || n2 == 0 || total == 0) return 1;
  const bm::binomial law(total, static_cast<double>(n1) / (n1 + n2));
  const double below = bm::cdf(law, first), above = first > 0 ? bm::cdf(bm::complement(law, first - 1)) : 1;
  return std::min(1.0, 2 * std::min(below, above));
}

LogRank log_rank(std::span<const Lifetime> a, std::span<const Lifetime> b) {
  struct Entry {
    double time;
    bool censored, first;
  };
  std::vector<Entry> entries;
  for (const Lifetime& x : a) entries.push_back({x.time, x.censored, true});
  for (const Lifetime& x : b) entries.push_back({x.time, x.censored, false});
  // At one time the events come before those that only leave.
  std::sort(entries.begin(), entries.end(),
            [](const Entry& x, const Entry& y) { return x.time != y.time ? x.time < y.time : x.censored < y.censored; });
  double at_risk = static_cast<double>(entries.size()), at_risk_first = static_cast<double>(a.size()), excess = 0, variance = 0;
  for (std::size_t i = 0; i < entries.size();) {
    double events = 0, events_first = 0, left = 0, left_first = 0;
    const double time = entries[i].time;
    for (; i < entries.size() && entries[i].time == time; ++i) {
      left += 1, left_first += entries[i].first;
      if (!entries[i].censored) events += 1, events_first += entries[i].first;
    }
    const double share = at_risk_first / at_risk;
    excess += events_first - events * share;
    if (at_risk > 1) variance += events * share * (1 - share) * (at_risk - events) / (at_risk - 1);
    at_risk -= left, at_risk_first -= left_first;
  }
  if (variance <= 0) return {};
  const double z = excess / std::sqrt(variance);
  return {z, two_sided_p(z)};
}

namespace {

// Sum over pairs of |x_i - x_j| of sorted values, each pair once.
double sum_of_distances(const std::vector<double>& sorted) {
  double sum = 0;
  const double n = static_cast<double>(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) sum += sorted[i] * (2 * static_cast<double>(i) - n + 1);
  return sum;
}

double energy_of_sorted(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> both(a.size() + b.size());
  std::merge(a.begin(), a.end(), b.begin(), b.end(), both.begin());
  const double n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  const double within_a = sum_of_distances(a), within_b = sum_of_distances(b), between = sum_of_distances(both) - within_a - within_b;
  return 2 * between / (n * m) - 2 * within_a / (n * n) - 2 * within_b / (m * m);
}

/// Of a sample of more than 500 values that many of its quantiles.
std::vector<double> thinned(std::span<const double> sample) {
  constexpr std::size_t most = 500;
  std::vector<double> values(sample.begin(), sample.end());
  if (values.size() <= most) return values;
  std::sort(values.begin(), values.end());
  std::vector<double> quantiles;
  for (std::size_t i = 0; i < most; ++i) quantiles.push_back(values[(2 * i + 1) * values.size() / (2 * most)]);
  return quantiles;
}

}  // namespace

double energy_distance(std::span<const double> a, std::span<const double> b) {
  std::vector<double> x(a.begin(), a.end()), y(b.begin(), b.end());
  std::sort(x.begin(), x.end()), std::sort(y.begin(), y.end());
  return energy_of_sorted(x, y);
}

double energy_test(std::span<const double> first, std::span<const double> second, std::uint64_t seed, int permutations) {
  const std::vector<double> a = thinned(first), b = thinned(second);
  const double observed = energy_distance(a, b);
  std::vector<double> all(a);
  all.insert(all.end(), b.begin(), b.end());
  NormalNumbers random(seed);
  int as_large = 1;
  for (int k = 0; k < permutations; ++k) {
    for (std::size_t i = all.size() - 1; i > 0; --i) std::swap(all[i], all[random.index(static_cast<int>(i) + 1)]);
    const std::span<const double> shuffled(all);
    as_large += energy_distance(shuffled.first(a.size()), shuffled.subspan(a.size())) >= observed * (1 - 1e-12);
  }
  return static_cast<double>(as_large) / (permutations + 1);
}

std::vector<bool> benjamini_hochberg(std::span<const double> p, double rate) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
  std::size_t rejected = 0;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (p[order[k]] <= rate * static_cast<double>(k + 1) / static_cast<double>(p.size())) rejected = k + 1;
  std::vector<bool> result(p.size(), false);
  for (std::size_t k = 0; k < rejected; ++k) result[order[k]] = true;
  return result;
}

namespace {

double bic(double residual_square, double n, double parameters) { return n * std::log(residual_square / n) + parameters * std::log(n); }

}  // namespace

double bic_of_line(std::span<const double> x, std::span<const double> y) {
  const double n = static_cast<double>(x.size());
  double mx = 0, my = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i)
    sxx += (x[i] - mx) * (x[i] - mx), sxy += (x[i] - mx) * (y[i] - my), syy += (y[i] - my) * (y[i] - my);
  return bic(syy - sxy * sxy / sxx, n, 2);
}

double bic_of_step(const std::vector<bool>& first, std::span<const double> y) {
  std::array<double, 2> sum{}, count{};
  for (std::size_t i = 0; i < y.size(); ++i) sum[first[i]] += y[i], count[first[i]] += 1;
  double square = 0;
  for (std::size_t i = 0; i < y.size(); ++i) square += std::pow(y[i] - sum[first[i]] / count[first[i]], 2);
  return bic(square, static_cast<double>(y.size()), 2);
}

}  // namespace snag
