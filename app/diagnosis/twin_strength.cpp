// How clearly what is true of a set can be seen in it.
#include <cmath>
#include <limits>

#include "app/diagnosis/twin_set.hpp"
#include "diagnosis/bench/detectability.hpp"

namespace snag {

namespace {

/// What is left of the weaker of two effects when the other one may have any strength: a set whose second effect cannot be seen cannot be
/// told.
double weaker_of_pair(const TwinSet& set, const std::vector<Asked>& asked, const std::vector<double>& variance,
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

/// Rows are all samples of the training points: one column an input, or an input of one point, or a bias; each one standard uncertainty.
std::vector<std::vector<double>> input_columns(const TwinSet& set, const std::vector<Asked>& asked) {
  const std::size_t n = asked.size(), rows = set.n_training() * n;
  std::map<std::string, std::vector<double>> shared;
  const auto column = [&](const std::string& name) -> std::vector<double>& {
    auto& values = shared[name];
    values.resize(rows, 0.0);
    return values;
  };
  for (std::size_t p = 0; p < set.n_training(); ++p) {
    const auto base = set.base_values(p, asked, {});
    for (const TwinInput& input : set.inputs()) {
      const auto moved = set.base_values(p, asked, {{input.key, input.u}});
      auto& values = column(input.of_each_point() ? input.key + std::to_string(p) : input.key);
      for (std::size_t i = 0; i < n; ++i) values[p * n + i] = set.difference(asked[i].observable, moved[i], base[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const TwinInstrument& instrument = set.instrument(asked[i].observable);
      if (instrument.bias_u > 0) column("bias " + instrument.group)[p * n + i] = instrument.bias_u;
    }
  }
  std::vector<std::vector<double>> columns;
  for (auto& [name, values] : shared) columns.push_back(std::move(values));
  return columns;
}

}  // namespace

void measure_gap(TwinSet& set) {
  const std::vector<Asked> asked = set.asked();
  std::vector<double> signal, variance;
  for (std::size_t p = 0; p < set.n_training(); ++p) {
    const auto with = set.true_values(p, asked), without = set.base_values(p, asked, set.deviations[p]);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const double noise = set.instrument(asked[i].observable).noise_u;
      signal.push_back(set.difference(asked[i].observable, with[i], without[i]));
      variance.push_back(noise * noise / set.truth.replicates);
    }
  }
  const auto columns = input_columns(set, asked);
  const SignalSize size = signal_size(signal, variance, columns);
  set.truth.detectability = set.truth.theta.size() > 1 ? weaker_of_pair(set, asked, variance, columns) : size.detectability;
  set.truth.gap_over_floor = size.gap_over_floor;
}

}  // namespace snag
