#include "observe/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/parameter.hpp"

namespace snag {

namespace {

constexpr double pi = std::numbers::pi;

/// Running mean over 2 n + 1 values of a closed curve.
std::vector<double> running_mean(const std::vector<double>& values, int n) {
  const int size = static_cast<int>(values.size());
  std::vector<double> mean(values.size());
  for (int i = 0; i < size; ++i) {
    double sum = 0;
    for (int k = -n; k <= n; ++k) sum += values[((i + k) % size + size) % size];
    mean[i] = sum / (2 * n + 1);
  }
  return mean;
}

/// How far the curve falls on one side of place i before it rises above it; infinite if it never does.
double fall(const std::vector<double>& curve, int i, int step) {
  const int size = static_cast<int>(curve.size());
  double low = curve[i];
  for (int k = 1; k < size; ++k) {
    const double value = curve[((i + k * step) % size + size) % size];
    // Of equal peaks the first one counts.
    if (value > curve[i] || (value == curve[i] && step < 0)) return curve[i] - low;
    low = std::min(low, value);
  }
  return curve[i] - low;
}

}  // namespace

double Outline::mean_wave_size() const {
  if (waves.empty()) return radius.empty() ? 0 : std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size());
  double sum = 0;
  for (const Wave& wave : waves) sum += wave.radius;
  return sum / static_cast<double>(waves.size());
}

double Outline::smallest_wave() const {
  double smallest = waves.empty() ? 0 : infinity;
  for (const Wave& wave : waves) smallest = std::min(smallest, wave.radius);
  return smallest;
}

Outline outline(const Coverage& picture, const OutlineSettings& settings) {
  const double x_reach =
      std::max(std::abs(picture.x0 - settings.centre_x), std::abs(picture.x0 + picture.nx * picture.side - settings.centre_x));
  const double y_reach =
      std::max(std::abs(picture.y0 - settings.centre_y), std::abs(picture.y0 + picture.ny * picture.side - settings.centre_y));
  const double step = picture.side / 4;
  const int n_steps = static_cast<int>(std::ceil(std::hypot(x_reach, y_reach) / step));
  std::vector<double> radius(settings.n_directions, 0.0);
  for (int d = 0; d < settings.n_directions; ++d) {
    const double angle = 2 * pi * d / settings.n_directions, c = std::cos(angle), s = std::sin(angle);
    for (int n = n_steps; n > 0; --n) {
      const double r = n * step;
      const int i = static_cast<int>(std::floor((settings.centre_x + r * c - picture.x0) / picture.side));
      const int j = static_cast<int>(std::floor((settings.centre_y + r * s - picture.y0) / picture.side));
      if (!picture.at(i, j)) continue;
      radius[d] = r;
      break;
    }
  }
  const int half_width = static_cast<int>(std::lround(settings.smoothing / 2 / (2 * pi) * settings.n_directions));
  return outline_from(running_mean(running_mean(radius, half_width), half_width), picture.area(), settings);
}

Outline outline_from(std::vector<double> radius, double area, const OutlineSettings& settings) {
  Outline result;
  result.area = area, result.radius = std::move(radius);
  const int n = static_cast<int>(result.radius.size());
  for (int d = 0; d < n; ++d) {
    const double prominence = std::min(fall(result.radius, d, 1), fall(result.radius, d, -1));
    if (prominence >= settings.prominence) result.waves.push_back({2 * pi * d / n, result.radius[d]});
  }
  return result;
}

}  // namespace snag
