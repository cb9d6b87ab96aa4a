#include "observe/repeats.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"
#include "observe/observables.hpp"

namespace snag {

bool Quantity::is_axis() const {
  const ObservableRecord* record = find_observable(name);
  return record && record->measure == Measure::axis_angle;
}

namespace {

constexpr double degrees = 180 / std::numbers::pi, half_turn = 180;

double mean_axis(const std::vector<double>& values) {
  double c = 0, s = 0;
  for (const double value : values) c += std::cos(2 * value / degrees), s += std::sin(2 * value / degrees);
  return 0.5 * degrees * std::atan2(s, c);
}

double checked(double value, const Repeats& repeats, const Repeats::Row& row, std::size_t o, const std::string& where) {
  if (std::isfinite(value)) return value;
  throw Error(ExitCode::usage, where + ": " + shortened(repeats.quantities[o].name) + " of group \"" +
                                   shortened(repeats.groups[row.group]) + "\" is " + number_text(value) +
                                   ", must be a finite number; leave out rows without one");
}

GroupComparison compare(const Repeats& repeats, std::size_t o, const std::string& where) {
  GroupComparison result;
  result.quantity = repeats.quantities[o];
  const bool is_axis = result.quantity.is_axis();
  std::vector<RagSample> samples;
  std::vector<double> all;
  std::vector<std::vector<double>> by_group(repeats.groups.size());
  for (const Repeats::Row& row : repeats.rows) {
    const double value = checked(row.values[o], repeats, row, o, where), twice = 2 * value / degrees;
    samples.push_back({row.group, row.rag, {is_axis ? std::cos(twice) : value, is_axis ? std::sin(twice) : 0}});
    all.push_back(value), by_group[row.group].push_back(value);
  }
  // Means of axes count from the mean of all, so that none of them lies more than 90 degrees from it.
  const double origin = is_axis ? mean_axis(all) : 0;
  const auto unwrapped = [&](double value) { return is_axis ? origin + std::remainder(value - origin, half_turn) : value; };

  std::vector<double> means, deviations, counts;
  for (const std::vector<double>& values : by_group) {
    const MeanAndSigma m = mean_and_sigma(values, result.quantity);
    means.push_back(unwrapped(m.mean)), deviations.push_back(m.sigma), counts.push_back(static_cast<double>(values.size()));
    result.groups.push_back({m, counts.back(), 0});
  }
  // What differs by round-off alone is constant.
  const double largest = std::abs(*std::max_element(all.begin(), all.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  if (std::all_of(deviations.begin(), deviations.end(), [&](double deviation) { return deviation <= 1e-12 * largest; }))
    throw Error(ExitCode::usage, where + ": " + shortened(result.quantity.name) + " does not vary within any group (" +
                                     number_text(means[0]) + " in \"" + shortened(repeats.groups[0]) +
                                     "\"), so that there is no scatter to compare with; leave it out");
  result.by_count = anova(means, deviations, counts);
  const IndependentSamples independent = independent_samples(samples, static_cast<int>(repeats.groups.size()));
  result.dependence = independent.dependence, result.correlation = independent.correlation;
  double n_independent = 0;
  for (std::size_t g = 0; g < counts.size(); ++g)
    result.groups[g].n_independent = independent.counts[g], n_independent += independent.counts[g];
  // A hair above: n_eff of one for each group comes with round-off.
  if (n_independent > static_cast<double>(counts.size()) * (1 + 1e-9)) result.by_independent = anova(means, deviations, independent.counts);
  return result;
}

}  // namespace

MeanAndSigma mean_and_sigma(const std::vector<double>& values, const Quantity& quantity) {
  const double n = static_cast<double>(values.size());
  MeanAndSigma m;
  if (quantity.is_axis())
    m.mean = mean_axis(values);
  else
    for (const double value : values) m.mean += value / n;
  double square = 0;
  for (const double value : values) {
    const double off = quantity.is_axis() ? std::remainder(value - m.mean, half_turn) : value - m.mean;
    square += off * off;
  }
  m.sigma = n > 1 ? std::sqrt(square / (n - 1)) : std::nan("");
  return m;
}

std::vector<GroupComparison> compare_groups(const Repeats& repeats, const std::string& where) {
  if (repeats.groups.size() < 2)
    throw Error(ExitCode::usage,
                where + ": " + std::to_string(repeats.groups.size()) +
                    (repeats.groups.size() == 1 ? " group (\"" + shortened(repeats.groups[0]) + "\")" : std::string(" groups")) +
                    ", there must be at least two to compare; name each operating point");
  std::vector<int> n(repeats.groups.size());
  for (const Repeats::Row& row : repeats.rows) ++n[row.group];
  for (std::size_t g = 0; g < n.size(); ++g)
    if (n[g] < 2)
      throw Error(ExitCode::usage, where + ": group \"" + shortened(repeats.groups[g]) + "\" has " + std::to_string(n[g]) +
                                       (n[g] == 1 ? " sample" : " samples") + ", must have at least two to have a scatter; add repeats");
  std::vector<GroupComparison> comparisons;
  for (std::size_t o = 0; o < repeats.quantities.size(); ++o) comparisons.push_back(compare(repeats, o, where));
  return comparisons;
}

}  // namespace snag
