#include "simulation/output/revolution_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

namespace snag {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
// A sample this close to the end of a revolution is at its end: the round-off of an angle after a great many steps.
constexpr double at_end = 1e-9;  // revolutions
constexpr std::size_t samples_a_harmonic = 4;

/// Values at a part of the way between two points.
std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double part) {
  std::vector<double> result(a.size());
  for (std::size_t q = 0; q < a.size(); ++q) result[q] = (1 - part) * a[q] + part * b[q];
  return result;
}

/// Solution of M x = b for a symmetric positive definite M of n rows, by Cholesky; M and b are used up.
std::vector<double> solved(std::vector<double> M, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t j = 0; j < n; ++j) {  // M = L L^T, L in the lower half
    for (std::size_t k = 0; k < j; ++k)
      for (std::size_t i = j; i < n; ++i) M[i * n + j] -= M[i * n + k] * M[j * n + k];
    const double pivot = std::sqrt(M[j * n + j]);
    for (std::size_t i = j; i < n; ++i) M[i * n + j] /= pivot;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= M[i * n + k] * b[k];
    b[i] /= M[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= M[k * n + i] * b[k];
    b[i] /= M[i * n + i];
  }
  return b;
}

/// 1, cos theta, sin theta, cos 2 theta ...
void fill_waves(double angle, std::vector<double>& waves) {
  waves[0] = 1;
  for (std::size_t h = 1; 2 * h < waves.size(); ++h)
    waves[2 * h - 1] = std::cos(static_cast<double>(h) * angle), waves[2 * h] = std::sin(static_cast<double>(h) * angle);
}

/// Points that are samples: all but the first, and the last one if it was interpolated.
std::size_t end_of_samples(const Revolution& revolution) { return revolution.turned.size() - (revolution.ends_with_sample ? 0 : 1); }

}  // namespace

double Revolution::angle(std::size_t point) const { return start_angle + direction * two_pi * turned[point]; }

double revolution_mean(const Revolution& revolution, std::size_t quantity) {
  const auto& [turned, values] = std::tie(revolution.turned, revolution.values);
  if (turned.empty()) return 0;
  double integral = 0;
  for (std::size_t i = 1; i < turned.size(); ++i)
    integral += (turned[i] - turned[i - 1]) * 0.5 * (values[i][quantity] + values[i - 1][quantity]);
  if (turned.back() > 0) return integral / turned.back();
  double total = 0;
  for (const auto& point : values) total += point[quantity];
  return total / static_cast<double>(values.size());
}

std::vector<double> revolution_means(const Revolution& revolution, std::size_t n) {
  std::vector<double> means;
  for (std::size_t q = 0; q < n; ++q) means.push_back(revolution_mean(revolution, q));
  return means;
}

Extremes revolution_extremes(const Revolution& revolution, std::size_t quantity) {
  if (revolution.values.size() < 2) return {};
  Extremes found{revolution.values[1][quantity], revolution.values[1][quantity]};
  for (std::size_t i = 1; i < end_of_samples(revolution); ++i) {
    found.lowest = std::min(found.lowest, revolution.values[i][quantity]);
    found.highest = std::max(found.highest, revolution.values[i][quantity]);
  }
  return found;
}

Spectrum revolution_spectrum(const Revolution& revolution, std::size_t quantity) {
  const std::size_t n_points = revolution.turned.size(), end = end_of_samples(revolution);
  if (end < 2) return {};
  const std::size_t n_harmonics = std::min(max_harmonics, (end - 1) / samples_a_harmonic), n = 2 * n_harmonics + 1;
  const auto share = [&](std::size_t i) { return 0.5 * (revolution.turned[std::min(i + 1, n_points - 1)] - revolution.turned[i - 1]); };
  // Normal equations: the waves are nearly orthogonal over a revolution, so that they lose nothing.
  std::vector<double> waves(n), matrix(n * n), right(n);
  for (std::size_t i = 1; i < end; ++i) {
    fill_waves(revolution.angle(i), waves);
    for (std::size_t r = 0; r < n; ++r) {
      right[r] += share(i) * waves[r] * revolution.values[i][quantity];
      for (std::size_t c = 0; c <= r; ++c) matrix[r * n + c] += share(i) * waves[r] * waves[c];
    }
  }
  const std::vector<double> parts = solved(std::move(matrix), std::move(right));
  Spectrum found;
  for (std::size_t h = 1; h <= n_harmonics; ++h)
    found.harmonics.push_back({std::hypot(parts[2 * h - 1], parts[2 * h]), std::atan2(parts[2 * h], parts[2 * h - 1])});
  double squares = 0, total = 0;
  for (std::size_t i = 1; i < end; ++i) {
    fill_waves(revolution.angle(i), waves);
    const double rest = revolution.values[i][quantity] - std::inner_product(waves.begin(), waves.end(), parts.begin(), 0.0);
    squares += share(i) * rest * rest, total += share(i);
  }
  if (total > 0) found.noise = std::sqrt(squares / total);
  return found;
}

std::vector<Revolution> RevolutionSampler::add(double turned, const std::vector<double>& values) {
  std::vector<Revolution> complete;
  if (turned < 0) current_.direction = -1;
  if (current_.turned.empty()) current_.turned = {0}, current_.values = {values};
  double place = std::abs(turned) / two_pi - static_cast<double>(current_.number - 1);
  while (place > 1 - at_end) {
    const bool is_sample = place < 1 + at_end;
    const double before = current_.turned.back(), part = is_sample ? 1 : (1 - before) / (place - before);
    const std::vector<double> last = between(current_.values.back(), values, part);
    current_.turned.push_back(1), current_.values.push_back(last);
    current_.ends_with_sample = is_sample;
    complete.push_back(current_);
    current_ = {current_.number + 1, current_.start_angle, current_.direction, {0}, {last}};
    if (is_sample) return complete;
    place -= 1;
  }
  current_.turned.push_back(place), current_.values.push_back(values);
  return complete;
}

std::vector<double> RevolutionSampler::state() const {
  std::vector<double> kept{static_cast<double>(current_.number), current_.direction, static_cast<double>(current_.turned.size())};
  kept.insert(kept.end(), current_.turned.begin(), current_.turned.end());
  for (const auto& values : current_.values) kept.insert(kept.end(), values.begin(), values.end());
  return kept;
}

void RevolutionSampler::restore(const std::vector<double>& state) {
  current_.number = static_cast<std::int64_t>(state[0]), current_.direction = state[1];
  const auto n_points = static_cast<std::size_t>(state[2]);
  current_.turned.assign(state.begin() + 3, state.begin() + 3 + static_cast<std::ptrdiff_t>(n_points));
  current_.values.clear();
  if (n_points == 0) return;
  const std::size_t n_quantities = (state.size() - 3 - n_points) / n_points;
  for (auto at = state.begin() + 3 + static_cast<std::ptrdiff_t>(n_points); at != state.end();
       at += static_cast<std::ptrdiff_t>(n_quantities))
    current_.values.emplace_back(at, at + static_cast<std::ptrdiff_t>(n_quantities));
}

PhaseAverage::PhaseAverage(std::size_t n_bins, std::size_t n_quantities)
    : n_bins_(n_bins), n_quantities_(n_quantities), mean_(n_bins * n_quantities), squares_(n_bins * n_quantities) {}

void PhaseAverage::add(const Revolution& revolution, const std::vector<std::size_t>& quantities) {
  std::vector<double> integral(n_bins_ * n_quantities_), width(n_bins_);
  const double bin_width = 1.0 / static_cast<double>(n_bins_);  // revolutions
  for (std::size_t i = 1; i < revolution.turned.size(); ++i) {
    // Each linear piece is cut where bins meet; x is the angle in revolutions, unreduced.
    const double a = revolution.angle(i - 1) / two_pi, b = revolution.angle(i) / two_pi, low = std::min(a, b), high = std::max(a, b);
    if (high <= low) continue;
    for (auto k = static_cast<std::int64_t>(std::floor(low / bin_width)); static_cast<double>(k) * bin_width < high; ++k) {
      const double from = std::max(low, static_cast<double>(k) * bin_width), to = std::min(high, static_cast<double>(k + 1) * bin_width);
      if (to <= from) continue;
      const double part = (0.5 * (from + to) - a) / (b - a);
      const auto n = static_cast<std::int64_t>(n_bins_);
      const auto bin = static_cast<std::size_t>(((k % n) + n) % n);
      width[bin] += to - from;
      for (std::size_t q = 0; q < n_quantities_; ++q) {
        const double middle = (1 - part) * revolution.values[i - 1][quantities[q]] + part * revolution.values[i][quantities[q]];
        integral[bin * n_quantities_ + q] += (to - from) * middle;
      }
    }
  }
  n_revolutions_ += 1;
  for (std::size_t e = 0; e < mean_.size(); ++e) {  // Welford (1962): no loss where the scatter is small
    const double value = integral[e] / width[e / n_quantities_], before = value - mean_[e];
    mean_[e] += before / n_revolutions_;
    squares_[e] += before * (value - mean_[e]);
  }
}

double PhaseAverage::angle(std::size_t bin) const { return two_pi * (static_cast<double>(bin) + 0.5) / static_cast<double>(n_bins_); }

double PhaseAverage::mean(std::size_t bin, std::size_t quantity) const { return mean_[bin * n_quantities_ + quantity]; }

double PhaseAverage::deviation(std::size_t bin, std::size_t quantity) const {
  return n_revolutions_ < 2 ? 0 : std::sqrt(squares_[bin * n_quantities_ + quantity] / (n_revolutions_ - 1));
}

std::vector<double> PhaseAverage::state() const {
  std::vector<double> kept{n_revolutions_};
  kept.insert(kept.end(), mean_.begin(), mean_.end());
  kept.insert(kept.end(), squares_.begin(), squares_.end());
  return kept;
}

void PhaseAverage::restore(const std::vector<double>& state) {
  n_revolutions_ = state[0];
  const auto n = static_cast<std::ptrdiff_t>(mean_.size());
  mean_.assign(state.begin() + 1, state.begin() + 1 + n);
  squares_.assign(state.begin() + 1 + n, state.end());
}

}  // namespace snag
