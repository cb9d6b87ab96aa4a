#include "diagnosis/fitting/emulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace snag {

namespace {

constexpr std::array amplitudes{0.03, 0.1, 0.3, 1.0};  // of the deviation from a line, over how far the values range
constexpr std::array lengths{0.2, 0.5, 1.0};           // over the range of the strengths
constexpr double level = 3, slope = 3;                 // standard deviations of c and b: the values themselves decide

double kernel(double s, double t, double amplitude, double length) {
  const double apart = (s - t) / length;
  return level * level + slope * slope * s * t + amplitude * amplitude * std::exp(-0.5 * apart * apart);
}

}  // namespace

Emulator::Emulator(std::vector<double> strengths, std::vector<std::vector<Response>> responses)
    : strengths_(std::move(strengths)), responses_(std::move(responses)) {
  for (std::size_t p = 0; p < responses_.front().size(); ++p) {
    rows_.emplace_back();
    for (Eigen::Index i = 0; i < responses_.front()[p].value.size(); ++i) rows_.back().push_back(emulated(p, i));
  }
}

Emulator::Row Emulator::emulated(std::size_t point, Eigen::Index i) const {
  const auto n = static_cast<Eigen::Index>(strengths_.size());
  Row row;
  Eigen::VectorXd values(n), noise(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Response& response = responses_[static_cast<std::size_t>(k)][point];
    const bool later = !response.later.empty() && response.later[static_cast<std::size_t>(i)];
    if (later || !std::isfinite(response.value[i])) return row;
    values[k] = response.value[i], noise[k] = response.scatter[i] / response.n_runs;
  }
  row.low = values.minCoeff(), row.high = values.maxCoeff(), row.mean = values.mean();
  row.scale = row.high - row.low;
  if (n < 3 || row.scale <= 0) return row;
  const Eigen::VectorXd y = (values.array() - row.mean) / row.scale;
  constexpr double rounding = 1e-8;
  double best = -std::numeric_limits<double>::infinity();
  for (const double amplitude : amplitudes) {
    for (const double length : lengths) {
      Eigen::MatrixXd K(n, n);
      for (Eigen::Index a = 0; a < n; ++a)
        for (Eigen::Index b = 0; b < n; ++b)
          K(a, b) =
              kernel(share(strengths_[static_cast<std::size_t>(a)]), share(strengths_[static_cast<std::size_t>(b)]), amplitude, length);
      K.diagonal().array() += noise.array() / (row.scale * row.scale) + rounding;
      const Eigen::LLT<Eigen::MatrixXd> factor(K);
      const Eigen::VectorXd weights = factor.solve(y);
      const Eigen::MatrixXd& L = factor.matrixLLT();
      const double log_marginal = -0.5 * y.dot(weights) - L.diagonal().array().log().sum();
      if (log_marginal > best) best = log_marginal, row.weights = weights, row.amplitude = amplitude, row.length = length;
    }
  }
  return row;
}

std::vector<Response> Emulator::at(double strength) const {
  const auto nearest = std::min_element(strengths_.begin(), strengths_.end(),
                                        [&](double a, double b) { return std::abs(a - strength) < std::abs(b - strength); });
  std::vector<Response> all = responses_[static_cast<std::size_t>(nearest - strengths_.begin())];
  for (std::size_t p = 0; p < all.size(); ++p) {
    for (Eigen::Index i = 0; i < all[p].value.size(); ++i) {
      const Row& row = rows_[p][static_cast<std::size_t>(i)];
      if (row.weights.size() == 0) continue;
      double value = 0;
      for (Eigen::Index k = 0; k < row.weights.size(); ++k)
        value += row.weights[k] * kernel(share(strength), share(strengths_[static_cast<std::size_t>(k)]), row.amplitude, row.length);
      all[p].value[i] = std::clamp(row.mean + row.scale * value, row.low, row.high);
    }
  }
  return all;
}

}  // namespace snag
