// How clearly what is true of a set can be seen in it.
#include <cmath>
#include <limits>

#include "benchmark/blind/twin_set.hpp"
#include "casework/input_nuisances.hpp"
#include "diagnosis/attribution/screening.hpp"
#include "diagnosis/score/detectability.hpp"

namespace snag {

namespace {

/// What one standard uncertainty of an input does to the samples of a point, with what acts or without it.
std::vector<double> change_by_input(const TwinSet& set, std::size_t point, const std::vector<ObservableRequest>& asked,
                                    const Nuisance& input, bool with_truth) {
  const auto moved = [&](double share) {
    auto deviations = set.deviations[point];
    deviations[input.name] += share * input.u;
    return with_truth ? set.values(point, asked, set.truth.theta, true, deviations) : set.base_values(point, asked, deviations);
  };
  const auto up = moved(0.5), down = moved(-0.5);
  std::vector<double> change;
  for (std::size_t i = 0; i < asked.size(); ++i) change.push_back(set.difference(asked[i].observable, up[i], down[i]));
  return change;
}

/// The directions that a diagnosis keeps free, each one standard uncertainty: rows are all samples of the training points. An input does
/// not do the same with what acts as without it; between the two states the mean of both is right to second order, so that an effect which
/// is nothing but an input far off is found along the input's own direction.
std::vector<std::vector<double>> input_columns(const TwinSet& set, const std::vector<ObservableRequest>& asked) {
  const std::size_t n = asked.size(), rows = set.n_training() * n;
  std::vector<const PointCase*> bases;
  std::vector<std::pair<std::string, double>> input_u;
  for (std::size_t p = 0; p < set.n_training(); ++p) bases.push_back(&set.cases[p]);
  for (const TwinInput& input : set.inputs()) input_u.emplace_back(input.key, input.u);
  std::vector<std::vector<double>> columns;
  for (const Nuisance& input : input_nuisances(bases, std::vector(bases.size(), input_u))) {
    columns.emplace_back(rows, 0.0);
    for (const int point : input.points) {
      const auto p = static_cast<std::size_t>(point);
      const auto without = change_by_input(set, p, asked, input, false), with = change_by_input(set, p, asked, input, true);
      for (std::size_t i = 0; i < n; ++i) columns.back()[p * n + i] = 0.5 * (without[i] + with[i]);
    }
  }
  std::map<std::string, std::vector<double>> biases;  // by calibration group
  for (std::size_t p = 0; p < set.n_training(); ++p)
    for (std::size_t i = 0; i < n; ++i) {
      const TwinInstrument& instrument = set.instrument(asked[i].observable);
      if (instrument.bias_u > 0) biases.try_emplace(instrument.group, rows, 0.0).first->second[p * n + i] = instrument.bias_u;
    }
  for (auto& [group, values] : biases) columns.push_back(std::move(values));
  return columns;
}

/// Of the mean of the replicates, all samples of the training points.
std::vector<double> noise_variance(const TwinSet& set, const std::vector<ObservableRequest>& asked, int replicates) {
  std::vector<double> variance;
  for (std::size_t p = 0; p < set.n_training(); ++p)
    for (const ObservableRequest& one : asked) variance.push_back(std::pow(set.instrument(one.observable).noise_u, 2) / replicates);
  return variance;
}

/// What is left of the weaker of two effects when the other one may have any strength: a set whose second effect cannot be seen cannot be
/// told.
double weaker_of_pair(const TwinSet& set, const std::vector<ObservableRequest>& asked, const std::vector<double>& variance,
                      const std::vector<std::vector<double>>& columns) {
  std::vector<std::vector<double>> alone;  // what each adds to the other
  for (const auto& [name, theta] : set.truth.theta) {
    auto without = set.truth.theta;
    without.erase(name);
    alone.emplace_back();
    for (std::size_t p = 0; p < set.n_training(); ++p) {
      const auto both = set.true_values(p, asked), other = set.values(p, asked, without, true, set.deviations[p]);
      for (std::size_t i = 0; i < asked.size(); ++i) alone.back().push_back(set.difference(asked[i].observable, both[i], other[i]));
    }
  }
  double weaker = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < alone.size(); ++e) {
    auto free = columns;
    constexpr double any_strength = 100;
    for (std::size_t other = 0; other < alone.size(); ++other) {
      if (other == e) continue;
      free.push_back(alone[other]);
      for (double& value : free.back()) value *= any_strength;
    }
    weaker = std::min(weaker, signal_size(alone[e], variance, free).detectability);
  }
  return weaker;
}

/// An effect that is another one in each replicate. With rho the mean square of what it does to one replicate at one point, in standard
/// uncertainties clear of the inputs, the likelihood of n replicates at all points gains n (rho - ln(1 + rho))/2 a point by it: this stands
/// for half the square of its detectability.
template <class Signal>
SignalSize size_of_random(const Signal& signal, int replicates, std::size_t n_points, std::vector<double> variance,
                          const std::vector<std::vector<double>>& columns) {
  for (double& one : variance) one *= replicates;  // of one replicate
  constexpr int draws = 8;
  double square = 0, gap = 0;
  for (int k = 1; k <= draws; ++k) {
    const SignalSize size = signal_size(signal(k), variance, columns);
    square += size.detectability * size.detectability / draws, gap += size.gap_over_floor * size.gap_over_floor / draws;
  }
  const double points = static_cast<double>(n_points), rho = square / points;
  return {std::sqrt(replicates * points * (rho - std::log1p(rho))), std::sqrt(gap)};
}

}  // namespace

std::vector<Effect> showable(const TwinSet& set) {
  const std::vector<PointCase>& cases = set.cases;
  CaseFeatures facts = cases.front().facts();
  for (const PointCase& one : cases) {
    facts.wall |= one.facts().wall, facts.gradient |= one.facts().gradient, facts.varies |= one.facts().varies;
    facts.uniform |= one.facts().uniform;
  }
  std::vector<Effect> effects = library_effects(facts, cases.front().forces());
  std::erase_if(effects, [](const Effect& e) { return !e.blind.empty(); });
  const std::vector<ObservableRequest> asked = set.asked("all");
  constexpr int replicates = 10;
  const auto variance = noise_variance(set, asked, replicates);
  const auto columns = input_columns(set, asked);
  std::vector<std::vector<double>> base;
  for (std::size_t p = 0; p < set.n_training(); ++p) base.push_back(set.base_values(p, asked, {}));
  std::erase_if(effects, [&](const Effect& effect) {
    const auto signal = [&](int replicate) {
      std::vector<double> all;
      for (std::size_t p = 0; p < set.n_training(); ++p) {
        const auto with = set.values(p, asked, {{effect.name, probe_strength(effect)}}, false, {}, replicate);
        for (std::size_t i = 0; i < asked.size(); ++i) all.push_back(set.difference(asked[i].observable, with[i], base[p][i]));
      }
      return all;
    };
    constexpr double seen = 3;  // standard uncertainties
    const SignalSize size =
        effect.random ? size_of_random(signal, replicates, set.n_training(), variance, columns) : signal_size(signal(0), variance, columns);
    return size.detectability < seen;
  });
  return effects;
}

void measure_gap(TwinSet& set) {
  const std::vector<ObservableRequest> asked = set.asked();
  const auto signal = [&](int replicate) {
    std::vector<double> all;
    for (std::size_t p = 0; p < set.n_training(); ++p) {
      const auto with = set.true_values(p, asked, replicate), without = set.base_values(p, asked, set.deviations[p]);
      for (std::size_t i = 0; i < asked.size(); ++i) all.push_back(set.difference(asked[i].observable, with[i], without[i]));
    }
    return all;
  };
  const auto variance = noise_variance(set, asked, set.truth.replicates);
  const auto columns = input_columns(set, asked);
  const SignalSize size = set.random.empty() ? signal_size(signal(0), variance, columns)
                                             : size_of_random(signal, set.truth.replicates, set.n_training(), variance, columns);
  set.truth.detectability = set.truth.theta.size() > 1 ? weaker_of_pair(set, asked, variance, columns) : size.detectability;
  set.truth.gap_over_floor = size.gap_over_floor;
}

}  // namespace snag
