#include "diagnosis/judgement/new_conditions.hpp"

#include <algorithm>
#include <array>

#include "diagnosis/judgement/next_experiment.hpp"

namespace snag {

namespace {

constexpr std::array factors{0.5, 2.0};
constexpr double worth_it = 2;  // times the nats of a repeat
constexpr std::size_t most_named = 3;

struct Tried {
  int point = 0;  // index of training
  int input = 0;  // of the nuisances
  double factor = 1;
};

/// Known inputs of each point of training, one nuisance each: keys of the case, not laws nor calibrations.
std::vector<Tried> all_conditions(const Responses& model) {
  std::vector<Tried> all;
  for (int p = 0; p < static_cast<int>(model.training().size()); ++p) {
    std::vector<std::string> seen;
    for (int j = 0; j < static_cast<int>(model.nuisances().size()); ++j) {
      const FreeNuisance& nuisance = model.nuisances()[static_cast<std::size_t>(j)];
      const bool is_input = nuisance.bias_observable < 0 && !nuisance.of_data && nuisance.u > 0 &&
                            nuisance.name.find('.') != std::string::npos && !nuisance.name.starts_with("drag_law_uncertainty");
      if (!is_input || !model.acts_at(j, model.training()[static_cast<std::size_t>(p)]) ||
          std::count(seen.begin(), seen.end(), nuisance.name) > 0)
        continue;
      seen.push_back(nuisance.name);
      for (const double factor : factors) all.push_back({p, j, factor});
    }
  }
  return all;
}

double cost_of(const Experiment& experiment, const std::string& input) {
  for (const auto& [key, cost] : experiment.costs)
    if (key == input) return cost;
  return 1;
}

State at_condition(const Responses& model, State state, const Tried& tried) {
  state.nuisances[tried.input] += (tried.factor - 1) / model.nuisances()[static_cast<std::size_t>(tried.input)].u;
  return lead_of(std::move(state));
}

}  // namespace

std::vector<NewCondition> new_conditions(Responses& model, const Attribution& attribution) {
  const int first = attribution.first(), second = rival_of(attribution, first);
  if (second < 0) return {};
  const Fit &a = attribution.fits[static_cast<std::size_t>(first)], &b = attribution.fits[static_cast<std::size_t>(second)];
  const std::vector<Tried> all = all_conditions(model);
  std::vector<Responses::Request> requests;
  for (const Tried& tried : all) {
    const int point = model.training()[static_cast<std::size_t>(tried.point)];
    const State of_a = at_condition(model, a.at.state, tried);
    requests.push_back({of_a, point}), requests.push_back({at_condition(model, b.at.state, tried), point});
    for (int j = 0; j < static_cast<int>(model.nuisances().size()); ++j) {
      if (!model.acts_at(j, point)) continue;
      requests.push_back({of_a, point});
      requests.back().state.nuisances[j] += nuisance_step;
    }
  }
  const int affordable = std::min(model.runs_left(), model.n_used() / 4);
  int n_runs = 0;
  for (const Responses::Request& request : requests) n_runs += model.n_seeds(request.state);
  if (requests.empty() || n_runs > affordable) return {};
  const std::vector<Response> answers = model.run(requests);
  const double of_repeat = best_repeat(model, a, b);
  std::vector<NewCondition> ranked;
  auto next = answers.begin();
  for (const Tried& tried : all) {
    const int point = model.training()[static_cast<std::size_t>(tried.point)];
    const Response &of_a = *next++, &of_b = *next++;
    Predictions predictions{finite(of_a.value - of_b.value), a.at.numerical_error[static_cast<std::size_t>(tried.point)], {}};
    if (model.base_is_random()) predictions.chance = (of_a.scatter + of_b.scatter) / of_a.n_runs;
    for (int j = 0; j < static_cast<int>(model.nuisances().size()); ++j) {
      if (!model.acts_at(j, point)) continue;
      predictions.by_input.push_back((next->value - of_a.value) / nuisance_step);
      ++next;
    }
    if (!of_a.failure.empty() || !of_b.failure.empty()) continue;
    const Separation separation = best_separation(model, static_cast<std::size_t>(tried.point), predictions);
    const std::string& input = model.nuisances()[static_cast<std::size_t>(tried.input)].name;
    const double cost = cost_of(model.experiment(), input);
    if (separation.T > worth_it * cost * of_repeat)
      ranked.push_back({separation.point, input, tried.factor, separation.observable, 0.5 * separation.T, 0.5 * of_repeat, cost});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const NewCondition& x, const NewCondition& y) { return x.nats / x.cost > y.nats / y.cost; });
  if (ranked.size() > most_named) ranked.resize(most_named);
  return ranked;
}

}  // namespace snag
