#include "diagnosis/data/mistakes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/parameter.hpp"
#include "base/units.hpp"
#include "base/words.hpp"
#include "diagnosis/data/summary.hpp"
#include "observe/observables.hpp"

namespace snag {

namespace {

/// Duration of the paths that are measured, s; 0: there are none.
double measured_duration(const Experiment& experiment) {
  double duration = 0;
  for (const Datum& d : experiment.data)
    if (!std::isnan(d.time)) duration = std::max(duration, d.time);
  return duration;
}

bool has_path(const Experiment& experiment, int observable) {
  return std::any_of(experiment.data.begin(), experiment.data.end(),
                     [&](const Datum& d) { return d.observable == observable && !std::isnan(d.time); });
}

// There or not: a range so narrow that linear models take it as it is, wide enough for their integrals.
Effect fixed_effect(const std::string& name, const std::string& parameter) {
  constexpr double width = 1e-4;
  return {.name = name,
          .parameter = parameter,
          .mean = 1,
          .sd = 1,
          .minimum = 1 - width,
          .maximum = 1 + width,
          .fixed = true,
          .is_mistake = true};
}

struct Interpolated {
  double value = 0, u = 0;
};

using Path = std::vector<std::pair<double, double>>;

/// The polynomial through the samples [begin, end).
double through(const Path& path, int begin, int end, double t) {
  double sum = 0;
  for (int i = begin; i < end; ++i) {
    const auto at = static_cast<std::size_t>(i);
    double weight = 1;
    for (int j = begin; j < end; ++j) {
      const auto other = static_cast<std::size_t>(j);
      if (j != i) weight *= (t - path[other].first) / (path[at].first - path[other].first);
    }
    sum += weight * path[at].second;
  }
  return sum;
}

/// Of a path at another time: the cubic through the four nearest samples, beyond the ends the line through the last two, which is as
/// uncertain as the parabola through the last three is away from it.
Interpolated at_time(const Path& path, double t) {
  const auto n = static_cast<int>(path.size());
  if (n == 1) return {path[0].second, 0};
  if (t >= path.front().first && t <= path.back().first) {
    const auto next = std::lower_bound(path.begin(), path.end(), t, [](const auto& sample, double time) { return sample.first < time; });
    const int after = std::clamp(static_cast<int>(next - path.begin()), 1, n - 1);
    return {through(path, std::max(0, after - 2), std::min(n, after + 2), t), 0};
  }
  const bool before = t < path.front().first;
  const double line = before ? through(path, 0, 2, t) : through(path, n - 2, n, t);
  const double parabola = before ? through(path, 0, std::min(n, 3), t) : through(path, std::max(0, n - 3), n, t);
  return {line, std::abs(parabola - line)};
}

}  // namespace

namespace {

/// Points that state an input as uncertain.
struct StatedInput {
  std::map<int, double> variance;        // of the relative deviation, by point
  std::set<std::vector<int>> one_value;  // points with the same value of it
};

std::ptrdiff_t n_training(const Experiment& experiment, const std::vector<int>& points) {
  return std::count_if(points.begin(), points.end(), [&](int p) { return !experiment.points[static_cast<std::size_t>(p)].withheld; });
}

/// A value that is wrong is so by a multiple of what was thought to be possible; u: largest standard uncertainty of these points.
Mistake wrong_input(const std::string& key, const std::string& name, const StatedInput& stated, const std::vector<int>& points) {
  constexpr double multiple = 10, named_from = 3;
  double variance = 0;
  for (const int p : points) variance = std::max(variance, stated.variance.at(p));
  const double u = std::sqrt(variance);
  return {.effect = {.name = name,
                     .parameter = "relative error of " + key,
                     .mean = 0,
                     .sd = multiple * u,
                     .minimum = -0.9,
                     .maximum = 9,
                     .least = named_from * u,
                     .is_mistake = true},
          .input = key,
          .points = points};
}

}  // namespace

std::vector<Mistake> mistakes_of_inputs(const Experiment& experiment, std::span<const Nuisance> nuisances) {
  std::set<std::string> calibrations;
  for (const Observable& observable : experiment.observables) calibrations.insert(calibration_of(observable));
  std::map<std::string, StatedInput> inputs;
  for (const Nuisance& n : nuisances) {
    // A drag law that is further off than it is known is drag_magnitude or drag_exponent, no input.
    if (n.u <= 0 || calibrations.contains(n.name) || n.name.starts_with("drag_law_uncertainty")) continue;
    StatedInput& stated = inputs[n.name];
    for (const int p : n.points) stated.variance[p] += n.u * n.u;
    if (n.points.size() > 1) stated.one_value.insert(n.points);
  }
  std::vector<Mistake> mistakes;
  for (const auto& [key, stated] : inputs) {
    std::vector<int> all;
    for (const auto& [p, variance] : stated.variance) all.push_back(p);
    if (all.size() < std::min<std::size_t>(2, experiment.points.size())) continue;
    mistakes.push_back(wrong_input(key, "input:" + key, stated, all));
    // One of several values may be wrong by itself: that of one kind of particle, of one of two liquids.
    for (const std::vector<int>& some : stated.one_value) {
      if (n_training(experiment, some) < 2 || n_training(experiment, some) == n_training(experiment, all)) continue;
      std::vector<std::string> ids;
      for (const int p : some) ids.push_back(experiment.points[static_cast<std::size_t>(p)].id);
      mistakes.push_back(wrong_input(key, "input:" + key + "@" + joined(ids), stated, some));
    }
  }
  return mistakes;
}

std::vector<Mistake> mistakes_of_measurement(const Experiment& experiment) {
  std::vector<Mistake> mistakes;
  const double duration = measured_duration(experiment);
  std::vector<int> paths, rates;
  std::map<int, double> periods;
  std::map<int, std::vector<int>> along;  // by axis
  for (int o = 0; o < static_cast<int>(experiment.observables.size()); ++o) {
    if (!has_path(experiment, o)) continue;
    paths.push_back(o);
    const Observable& observable = experiment.observables[static_cast<std::size_t>(o)];
    if (observable.kind == Observable::Kind::angle) periods[o] = angle_period(observable);
    const ObservableRecord* record = find_observable(observable.id);
    if (record && record->measure == Measure::velocity) rates.push_back(o);
    if (record && (record->is_position() || record->measure == Measure::velocity)) along[static_cast<int>(record->axis)].push_back(o);
  }
  if (paths.empty() || duration <= 0) return mistakes;
  constexpr double usual_delay = 0.05, largest_delay = 0.2;  // of the duration
  mistakes.push_back({.kind = Mistake::Kind::clock,
                      .effect = {.name = "clock",
                                 .parameter = "time by which the clock of the measurement starts late",
                                 .unit = "s",
                                 .mean = 0,
                                 .sd = usual_delay * duration,
                                 .minimum = -largest_delay * duration,
                                 .maximum = largest_delay * duration,
                                 .is_mistake = true},
                      .observables = paths,
                      .periods = periods});
  mistakes.push_back({.kind = Mistake::Kind::frame_rate,
                      .effect = {.name = "frame_rate",
                                 .parameter = "relative error of the times, as by another frame rate",
                                 .mean = 0,
                                 .sd = 0.05,
                                 .minimum = -0.3,
                                 .maximum = 0.3,
                                 .is_mistake = true},
                      .observables = paths,
                      .periods = periods,
                      .rates = rates});
  for (const auto& [axis, observables] : along)
    mistakes.push_back({.kind = Mistake::Kind::sign,
                        .effect = fixed_effect(std::string("sign:") + "xyz"[axis], "other sign of the axis"),
                        .observables = observables});
  return mistakes;
}

namespace {

/// Observables that one factor can be wrong of: those of a calibration group, else those with one unit, as one instrument measures them.
std::map<std::string, std::vector<int>> calibrations_of(const Experiment& experiment) {
  std::map<std::string, std::vector<int>> calibrations;
  for (int o = 0; o < static_cast<int>(experiment.observables.size()); ++o) {
    const Observable& observable = experiment.observables[static_cast<std::size_t>(o)];
    if (observable.kind != Observable::Kind::gaussian && observable.kind != Observable::Kind::lognormal) continue;
    calibrations[observable.calibration_group.empty() ? observable.unit : observable.calibration_group].push_back(o);
  }
  return calibrations;
}

/// From the lowest to the highest number of an observable, zero among them.
double range_of(const Experiment& experiment, int observable) {
  double low = 0, high = 0;
  for (const Datum& d : experiment.data)
    if (d.observable == observable) low = std::min(low, d.value), high = std::max(high, d.value);
  return high - low;
}

}  // namespace

std::vector<Mistake> mistakes_of_groups(const Experiment& experiment) {
  std::map<std::string, std::vector<int>> groups;
  int n_training = 0;
  for (int p = 0; p < static_cast<int>(experiment.points.size()); ++p) {
    const OperatingPoint& point = experiment.points[static_cast<std::size_t>(p)];
    n_training += !point.withheld;
    if (!point.group.empty()) groups[point.group].push_back(p);
  }
  const auto calibrations = calibrations_of(experiment);
  std::map<std::string, std::vector<int>> of_one_unit;  // observables of several calibrations
  std::map<std::string, int> n_calibrations;
  for (const auto& [calibration, observables] : calibrations) {
    const std::string& unit = experiment.observables[static_cast<std::size_t>(observables.front())].unit;
    ++n_calibrations[unit];
    of_one_unit[unit].insert(of_one_unit[unit].end(), observables.begin(), observables.end());
  }
  std::erase_if(of_one_unit, [&](const auto& of) { return n_calibrations[of.first] < 2; });
  constexpr double sd = 0.05, most = 0.5;  // of a factor that is thought to be one; of an offset, over the range of the numbers
  std::vector<Mistake> mistakes;
  const auto add = [&](Mistake::Kind kind, const std::string& name, const std::string& parameter, const std::string& unit, double size,
                       const std::vector<int>& points, const std::vector<int>& observables) {
    mistakes.push_back({.kind = kind,
                        .effect = {.name = name,
                                   .parameter = parameter,
                                   .unit = unit,
                                   .mean = 0,
                                   .sd = sd * size,
                                   .minimum = -most * size,
                                   .maximum = most * size,
                                   .is_mistake = true},
                        .points = points,
                        .observables = observables});
  };
  for (const auto& [group, points] : groups) {
    const auto training =
        std::count_if(points.begin(), points.end(), [&](int p) { return !experiment.points[static_cast<std::size_t>(p)].withheld; });
    if (training == 0 || training == n_training) continue;
    // Several calibrations of one unit may be those of one instrument, the axes of a camera: then one factor is wrong of all of them.
    for (const auto& [unit, observables] : of_one_unit)
      add(Mistake::Kind::scale, "scale:" + group + (of_one_unit.size() > 1 ? "/" + unit : ""),
          "relative error of all calibrations at these points", "1", 1, points, observables);
    for (const auto& [calibration, observables] : calibrations) {
      const std::string name = "scale:" + group + (calibrations.size() > 1 ? "/" + calibration : "");
      add(Mistake::Kind::scale, name, "relative error of a calibration at these points", "1", 1, points, observables);
      for (const int o : observables) {
        const Observable& observable = experiment.observables[static_cast<std::size_t>(o)];
        const double size = range_of(experiment, o);
        if (observable.kind != Observable::Kind::gaussian || size == 0) continue;
        const double unit = parse_unit(observable.unit)->factor;
        add(Mistake::Kind::offset, "offset:" + observable.id + "@" + group, "offset of the numbers at these points", observable.unit,
            size / unit, points, {o});
        mistakes.back().factor = unit;
      }
    }
  }
  return mistakes;
}

std::vector<Mistake> mistakes_of_unit(const Experiment& experiment, const std::string& unit, double ratio) {
  constexpr double degree = std::numbers::pi / 180, inch = 25.4;
  constexpr double near = 0.2;  // of the logarithm
  for (const double factor : {1e-3, 1e-2, 0.1, 10.0, 1e2, 1e3, degree, 1 / degree, inch, 1 / inch, 60.0, 1 / 60.0}) {
    if (!(ratio > 0) || std::abs(std::log(ratio / factor)) > near) continue;
    Mistake mistake{.kind = Mistake::Kind::unit,
                    .effect = fixed_effect("unit:" + unit, "data that are " + number_text(factor) + " times the true numbers"),
                    .factor = factor};
    for (int o = 0; o < static_cast<int>(experiment.observables.size()); ++o)
      if (experiment.observables[static_cast<std::size_t>(o)].unit == unit) mistake.observables.push_back(o);
    return {mistake};
  }
  return {};
}

std::vector<double> mismeasure(const Mistake& mistake, double theta, const std::vector<Slot>& slots, std::vector<double>& values) {
  std::vector<double> u(values.size(), 0);
  const auto changes = [&](std::size_t s) {
    return std::count(mistake.observables.begin(), mistake.observables.end(), slots[s].observable) > 0;
  };
  if (mistake.kind == Mistake::Kind::sign || mistake.kind == Mistake::Kind::unit) {
    for (std::size_t s = 0; s < values.size(); ++s)
      if (changes(s)) values[s] *= mistake.kind == Mistake::Kind::sign ? -1 : mistake.factor;
    return u;
  }
  if (mistake.kind == Mistake::Kind::scale || mistake.kind == Mistake::Kind::offset) {
    for (std::size_t s = 0; s < values.size(); ++s)
      if (changes(s)) values[s] = mistake.kind == Mistake::Kind::scale ? (1 + theta) * values[s] : values[s] + theta * mistake.factor;
    return u;
  }
  std::map<int, Path> paths;  // by observable
  for (std::size_t s = 0; s < values.size(); ++s)
    if (changes(s) && !std::isnan(slots[s].time) && std::isfinite(values[s]))
      paths[slots[s].observable].emplace_back(slots[s].time, values[s]);
  for (auto& [observable, path] : paths) {
    std::sort(path.begin(), path.end());
    const auto period = mistake.periods.find(observable);
    for (std::size_t i = 1; i < path.size() && period != mistake.periods.end(); ++i)
      path[i].second = path[i - 1].second + wrapped(path[i].second - path[i - 1].second, period->second);
  }
  for (std::size_t s = 0; s < values.size(); ++s) {
    const double t = slots[s].time;
    if (!changes(s) || std::isnan(t) || !std::isfinite(values[s])) continue;
    const Interpolated there = at_time(paths[slots[s].observable], mistake.kind == Mistake::Kind::clock ? t + theta : (1 + theta) * t);
    const bool is_rate = std::count(mistake.rates.begin(), mistake.rates.end(), slots[s].observable) > 0;
    values[s] = there.value * (is_rate ? 1 + theta : 1), u[s] = there.u * (is_rate ? 1 + theta : 1);
  }
  return u;
}

}  // namespace snag
