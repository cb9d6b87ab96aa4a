#include "simulation/plateau.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace snag {

namespace {

std::vector<double> values_of_x(const std::vector<PlateauRun>& runs) {
  std::vector<double> x;
  for (const PlateauRun& run : runs) x.push_back(run.x);
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
  return x;
}

/// Mean of each result in each condition; absent if a run lacks a value.
std::optional<std::map<std::string, std::vector<double>>> means(const std::vector<const PlateauRun*>& runs) {
  std::map<std::string, std::vector<double>> mean;
  std::map<std::string, double> n;
  for (const PlateauRun* run : runs) {
    std::vector<double>& of = mean[run->condition];
    of.resize(run->results.size());
    n[run->condition] += 1;
    for (std::size_t r = 0; r < of.size(); ++r) {
      if (!run->results[r]) return {};
      of[r] += *run->results[r];
    }
  }
  for (auto& [condition, of] : mean)
    for (double& sum : of) sum /= n[condition];
  return mean;
}

std::optional<PlateauWindow> window_of(const std::vector<PlateauRun>& runs, const std::vector<double>& x, std::size_t first,
                                       std::size_t last) {
  std::vector<const PlateauRun*> in;
  for (const PlateauRun& run : runs)
    if (run.x >= x[first] && run.x <= x[last]) in.push_back(&run);
  const auto mean = means(in);
  if (!mean) return {};
  PlateauWindow window{.from = x[first], .to = x[last], .n = last - first + 1};
  for (const PlateauRun* run : in)
    for (std::size_t r = 0; r < run->results.size(); ++r) {
      const double m = mean->at(run->condition)[r], q = *run->results[r];
      const double deviation = q == m ? 0 : m == 0 ? std::numeric_limits<double>::infinity() : std::abs(q / m - 1);
      if (!(deviation <= window.deviation)) window.deviation = deviation, window.worst = r, window.worst_group = run->group;
    }
  const double centre = std::sqrt(window.from * window.to);
  window.middle = *std::min_element(x.begin() + static_cast<std::ptrdiff_t>(first), x.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                                    [&](double a, double b) { return std::abs(std::log(a / centre)) < std::abs(std::log(b / centre)); });
  return window;
}

bool is_wider(const PlateauWindow& a, const PlateauWindow& b) {
  const double width_a = a.to / a.from, width_b = b.to / b.from;
  return width_a != width_b ? width_a > width_b : a.deviation < b.deviation;
}

std::optional<PlateauWindow> best_window(const std::vector<PlateauRun>& runs, double tolerance, std::size_t n_least) {
  const std::vector<double> x = values_of_x(runs);
  std::optional<PlateauWindow> plateau, nearest;
  for (std::size_t first = 0; first + n_least <= x.size(); ++first)
    for (std::size_t last = first + n_least - 1; last < x.size(); ++last) {
      std::optional<PlateauWindow> window = window_of(runs, x, first, last);
      if (!window) continue;
      window->within_tolerance = window->deviation <= tolerance;
      if (window->within_tolerance && (!plateau || is_wider(*window, *plateau))) plateau = window;
      if (window->n == n_least && (!nearest || window->deviation < nearest->deviation)) nearest = window;
    }
  return plateau ? plateau : nearest;
}

}  // namespace

Plateau find_plateau(const std::vector<PlateauRun>& runs, double tolerance, std::size_t n_least) {
  Plateau plateau{best_window(runs, tolerance, n_least), {}};
  std::vector<std::pair<std::string, std::vector<PlateauRun>>> groups;
  for (const PlateauRun& run : runs) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& known) { return known.first == run.group; });
    if (group == groups.end()) group = groups.insert(groups.end(), {run.group, {}});
    group->second.push_back(run);
  }
  for (const auto& [name, of] : groups) plateau.by_group.emplace_back(name, best_window(of, tolerance, n_least));
  return plateau;
}

}  // namespace snag
