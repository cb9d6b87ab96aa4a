#include "diagnosis/fitting/response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/error.hpp"
#include "base/words.hpp"
#include "diagnosis/data/between_series.hpp"

namespace snag {

namespace {

/// Standard deviation of the law that holds from the form next to it, over the difference to another form.
constexpr double between_forms = 1.0 / 3;

constexpr int most_seeds = 8, enough_for_scatter = 5;

bool random_effects_may_show(const Simulator& simulator) {
  const auto& effects = simulator.effects();
  return std::any_of(effects.begin(), effects.end(), [](const Effect& e) { return e.random && e.blind.empty(); });
}

// Value of a row in one run; NaN if the run has no such number. Along a path the last number before a gap stands in for it.
double row_value(const Row& row, const Observable& observable, const RunResult& run) {
  const double period = angle_period(observable);
  double sum = 0, last = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < row.slots.size(); ++k) {
    double value = run.values[row.slots[k]];
    if (observable.kind == Observable::Kind::lognormal) value = value > 0 ? std::log(value) : std::numeric_limits<double>::quiet_NaN();
    if (std::isnan(value)) value = last;
    last = value;
    if (observable.kind == Observable::Kind::angle && !row.means.empty()) value = row.means[k] + wrapped(value - row.means[k], period);
    sum += row.weights[k] * value;
  }
  return sum;
}

// Logarithm of the time at which the runs of a point end, as the data say it; where that is not known they lasted as long as the tests.
double log_end(const Row& row, const Simulator& simulator, int point, double factor_of_unit) {
  const double end = simulator.run_end(point);
  return end > 0 ? std::log(factor_of_unit * end) : *std::max_element(row.values.begin(), row.values.end());
}

// Mean over the slots of the variance between runs.
double variance_between(const Row& row, const Observable& observable, std::span<const RunResult> runs) {
  double variance = 0;
  for (std::size_t k = 0; k < row.slots.size(); ++k) {
    double first = 0, mean = 0, square = 0;
    int n = 0;
    for (const RunResult& run : runs) {
      double value = run.failure.empty() ? run.values[row.slots[k]] : std::numeric_limits<double>::quiet_NaN();
      if (observable.kind == Observable::Kind::lognormal) value = std::log(value);
      if (!std::isfinite(value)) continue;
      if (n == 0) first = value;
      const double d = observable.kind == Observable::Kind::angle ? wrapped(value - first, angle_period(observable)) : value - first;
      mean += d, square += d * d, ++n;
    }
    if (n > 1) variance += row.weights[k] * std::max(0.0, square - mean * mean / n) / (n - 1);
  }
  return variance;
}

}  // namespace

Responses::Responses(const Experiment& experiment, Simulator& simulator)
    : experiment_(experiment),
      simulator_(simulator),
      effects_(simulator.effects()),
      has_spread_(random_effects_may_show(simulator)),
      points_(summarize(experiment, simulator, has_spread_)) {
  for (int p = 0; p < static_cast<int>(experiment.points.size()); ++p) (experiment.points[p].withheld ? withheld_ : training_).push_back(p);
  std::set<std::string> told, calibrations;
  for (const Observable& observable : experiment.observables)
    if (observable.bias_u > 0) calibrations.insert(calibration_of(observable));
  for (const Nuisance& n : simulator.nuisances()) {
    if (n.u > 0) nuisances_.push_back({n.name, n.u, n.points, -1, calibrations.contains(n.name)});
    told.insert(n.name);
  }
  std::vector<int> all(experiment.points.size());
  for (std::size_t p = 0; p < all.size(); ++p) all[p] = static_cast<int>(p);
  for (int o = 0; o < static_cast<int>(experiment.observables.size()); ++o) {
    const Observable& observable = experiment.observables[o];
    if (observable.bias_u > 0 && !told.contains(calibration_of(observable)))
      nuisances_.push_back({"bias of " + observable.id, 1, all, o, true, observable.bias_u});
  }
  for (const BetweenSeries& term : between_series(experiment, points_))
    nuisances_.push_back({term.name, 1, term.points, term.observable, true, term.u});
  find_randomness();
  if (base_is_random_ && seeds_of_random_ < enough_for_scatter) find_scatter();
  const std::vector<Response> answers = run(base(), all);
  find_mistakes(answers);
  leave_out_rows_without_answer(answers);
}

int Responses::add_local(int of, Gate gate) {
  Effect local = effects_[static_cast<std::size_t>(of)];
  gate.effect = local.name;
  local.name += "@" + gate.coordinate();
  local.is_local = true;
  effects_.push_back(std::move(local)), gates_.push_back(std::move(gate));
  return static_cast<int>(effects_.size()) - 1;
}

const Gate* Responses::gate_of(int effect) const {
  const auto first = static_cast<int>(effects_.size() - gates_.size());
  return effect < first ? nullptr : &gates_[static_cast<std::size_t>(effect - first)];
}

void Responses::set_gate(int local_effect, Gate gate) {
  Gate& own = gates_.at(static_cast<std::size_t>(local_effect) - (effects_.size() - gates_.size()));
  gate.effect = own.effect;
  own = std::move(gate);
}

bool Responses::acts_at(int nuisance, int point) const {
  const auto& points = nuisances_[nuisance].points;
  return std::find(points.begin(), points.end(), point) != points.end();
}

std::string Responses::name_of_nuisance(int nuisance) const {
  const FreeNuisance& own = nuisances_[static_cast<std::size_t>(nuisance)];
  if (own.points.size() == experiment_.points.size() || own.name.find('@') != std::string::npos) return own.name;
  std::vector<std::string> points;
  for (const int p : own.points) points.push_back(experiment_.points[static_cast<std::size_t>(p)].id);
  return own.name + "@" + joined(points);
}

bool Responses::acts_at_random(const State& state) const {
  return std::any_of(state.effects.begin(), state.effects.end(), [&](const auto& e) { return e.second != 0 && effects()[e.first].random; });
}

int Responses::n_seeds(const State& state) const {
  if (base_is_random_) return seeds_of_random_;
  // Where chance comes with one effect alone, few states need their seeds.
  return acts_at_random(state) ? std::min(most_seeds, 2 * seeds_of_random_) : 1;
}

int Responses::n_seeds_of_distribution(const State& state) const {
  constexpr int more = 8;
  const int n = n_seeds(state);
  return n > 1 && !base_is_random_ ? more * n : n;
}

std::vector<OtherForm> other_forms(const State& state, const std::vector<Effect>& effects) {
  std::vector<OtherForm> others;
  for (std::size_t e = 0; e < state.effects.size(); ++e) {
    const Effect& effect = effects[state.effects[e].first];
    for (int form = effect.exclusive_forms ? effect.n_forms : 0; form < effect.n_forms + effect.n_deviations; ++form)
      if (form != state.form(e)) others.push_back({e, form, form < effect.n_forms ? between_forms : 1});
  }
  return others;
}

Eigen::VectorXd finite(const Eigen::VectorXd& values) {
  return values.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

State lead_of(State state) {
  state.shares.resize(0);
  return state;
}

Response beside(const Response& mixture, const Response& lead, Response moved) {
  const Eigen::VectorXd difference = mixture.value - lead.value;
  for (Eigen::Index i = 0; i < difference.size(); ++i)
    if (std::isfinite(difference[i])) moved.value[i] += difference[i];
  return moved;
}

std::vector<RunRequest> Responses::requests_of(const Request& request) const {
  RunRequest run;
  run.point = request.point, run.step_factor = request.step_factor, run.restart = request.state.restart;
  for (std::size_t e = 0; e < request.state.effects.size(); ++e) {
    const auto& [k, theta] = request.state.effects[e];
    if (theta == 0) continue;
    if (const Mistake* made = mistake(k); made != nullptr) {
      const bool there = std::count(made->points.begin(), made->points.end(), request.point) > 0;
      if (made->kind == Mistake::Kind::input && there) run.nuisances[made->input] += theta;
      continue;
    }
    const Gate* local = gate_of(k);
    const std::string& name = local ? local->effect : effects()[k].name;
    run.effects[name] = theta;
    if (request.state.form(e) != 0) run.forms[name] = request.state.form(e);
    if (local) run.gate = *local;
    if (request.state.gate && request.state.gate->effect == name) run.gate = request.state.gate;
  }
  for (std::size_t j = 0; j < nuisances_.size(); ++j) {
    const double deviation = request.state.nuisances[static_cast<Eigen::Index>(j)];
    if (deviation != 0 && nuisances_[j].bias_observable < 0 && acts_at(static_cast<int>(j), request.point))
      run.nuisances[nuisances_[j].name] += deviation * nuisances_[j].u;
  }
  std::vector<RunRequest> runs(seeds_of(request), run);
  for (std::size_t s = 0; s < runs.size(); ++s) runs[s].seed = experiment_.seed + s;
  return runs;
}

Response Responses::response(const Request& request, std::span<const RunResult> results, const std::vector<double>& u) const {
  const PointSummary& point = points_[request.point];
  const int n = static_cast<int>(point.rows.size()), n_seeds = static_cast<int>(results.size());
  // A case that answers the same for every seed says that an event always comes, or never. It may still be wrong near a threshold.
  constexpr int answers_of_sure_run = 20;
  const bool is_sure = n_seeds == 1 && !base_is_random_ && !acts_at_random(request.state);
  Response response{Eigen::VectorXd::Zero(n),
                    Eigen::VectorXd::Zero(n),
                    {},
                    n_seeds,
                    is_sure ? answers_of_sure_run : n_seeds,
                    "",
                    Eigen::VectorXd::Zero(n),
                    {},
                    {},
                    std::vector<bool>(n, false)};
  Eigen::MatrixXd values(n, n_seeds);
  for (int i = 0; i < n; ++i) {
    const Row& row = point.rows[i];
    const Observable& observable = experiment_.observables[row.observable];
    double sum = 0, square = 0;
    int counted = 0, came = 0;
    for (int s = 0; s < n_seeds; ++s) {
      values(i, s) = results[s].failure.empty() ? row_value(row, observable, results[s]) : std::numeric_limits<double>::quiet_NaN();
      came += std::isfinite(values(i, s));
      // A run that ended first says that the time is not earlier.
      if (row.kind == Row::Kind::time && results[s].failure.empty() && !std::isfinite(values(i, s)))
        values(i, s) = log_end(row, simulator_, request.point, factor_of_unit(request.state, row.observable));
      if (std::isfinite(values(i, s))) sum += values(i, s), ++counted;
    }
    response.later[i] = row.kind == Row::Kind::time && came == 0 && counted > 0;
    const double mean = counted > 0 ? sum / counted : std::numeric_limits<double>::quiet_NaN();
    for (int s = 0; s < n_seeds; ++s) {
      if (std::isfinite(values(i, s)))
        square += (values(i, s) - mean) * (values(i, s) - mean);
      else
        values(i, s) = mean;
    }
    response.value[i] = row.kind == Row::Kind::spread ? variance_between(row, observable, results) : mean;
    response.scatter[i] = counted > 1 ? square / (counted - 1) : 0;
    if (!scatter_of_base_.empty() && !acts_at_random(request.state))
      response.scatter[i] = scatter_of_base_[static_cast<std::size_t>(request.point)][i];
    for (std::size_t k = 0; k < row.slots.size() && !u.empty(); ++k) {
      const auto slot = static_cast<std::size_t>(row.slots[k]);
      if (u[slot] == 0) continue;
      response.beyond[i] +=
          row.weights[k] * u[slot] / (observable.kind == Observable::Kind::lognormal ? std::abs(results[0].values[slot]) : 1);
    }
  }
  for (std::size_t j = 0; j < nuisances_.size(); ++j) {
    if (nuisances_[j].bias_observable < 0 || !acts_at(static_cast<int>(j), request.point)) continue;
    const int biased = nuisances_[j].bias_observable;
    const bool is_relative = experiment_.observables[static_cast<std::size_t>(biased)].kind == Observable::Kind::lognormal;
    const double bias = request.state.nuisances[static_cast<Eigen::Index>(j)] * nuisances_[j].bias *
                        (is_relative ? 1 : factor_of_unit(request.state, biased));
    for (int i = 0; i < n; ++i)
      if (point.rows[i].observable == nuisances_[j].bias_observable && point.rows[i].kind != Row::Kind::spread) response.value[i] += bias;
  }
  response.data_covariance = covariance_in_right_units(request.state, request.point);
  response.spread_noise_u = spread_noise_in_right_units(request.state, request.point);
  if (n_seeds > 1) response.paths = values.topRows(point.n_gaussian).colwise() - values.topRows(point.n_gaussian).rowwise().mean();
  if (std::all_of(results.begin(), results.end(), [](const RunResult& r) { return !r.failure.empty(); }))
    response.failure = results.front().failure;
  return response;
}

// The state with the leading forms only, then one with each other form that has a share.
std::vector<Responses::Part> Responses::parts_of(const Request& request) const {
  std::vector<Part> all{{request, 1}};
  const auto others = other_forms(request.state, effects());
  for (Eigen::Index s = 0; s < request.state.shares.size(); ++s) {
    const OtherForm& other = others[static_cast<std::size_t>(s)];
    if (request.state.shares[s] == 0 || request.state.effects[other.effect].second == 0) continue;
    all.push_back({request, other.sd * request.state.shares[s]});
    auto& forms = all.back().request.state.forms;
    forms.resize(std::max(forms.size(), other.effect + 1), 0);
    forms[other.effect] = other.form;
  }
  return all;
}

void Responses::add_share(Response& sum, const Response& lead, const Response& other, double share, int point) const {
  const Eigen::VectorXd change = share * (other.value - lead.value);
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    if (!std::isfinite(change[i])) continue;
    sum.value[i] += change[i];
    const Row::Kind kind = points_[point].rows[static_cast<std::size_t>(i)].kind;
    if (kind == Row::Kind::count || kind == Row::Kind::spread) sum.value[i] = std::max(0.0, sum.value[i]);
    if (kind == Row::Kind::event) sum.value[i] = std::clamp(sum.value[i], 0.0, 1.0);
  }
}

std::vector<Response> Responses::run(const std::vector<Request>& requests) {
  std::vector<RunRequest> runs;
  std::vector<std::vector<Part>> parts;
  for (const Request& request : requests) {
    parts.push_back(parts_of(request));
    for (const Part& part : parts.back())
      for (RunRequest& run : requests_of(part.request)) runs.push_back(std::move(run));
  }
  std::vector<RunResult> results = simulator_.run(runs);
  std::vector<Response> responses;
  std::size_t begin = 0;
  for (const std::vector<Part>& all : parts) {
    std::vector<Response> of_parts;
    for (const Part& part : all) {
      const std::size_t n = static_cast<std::size_t>(seeds_of(part.request));
      const std::vector<double> u = mismeasure(part.request.state, part.request.point, std::span(results).subspan(begin, n));
      of_parts.push_back(response(part.request, std::span(results).subspan(begin, n), u));
      begin += n;
    }
    responses.push_back(of_parts.front());
    for (std::size_t i = 1; i < all.size(); ++i)
      add_share(responses.back(), of_parts.front(), of_parts[i], all[i].share, all[i].request.point);
  }
  return responses;
}

std::vector<Response> Responses::run(const State& state, const std::vector<int>& points, double step_factor) {
  std::vector<Request> requests;
  for (const int p : points) requests.push_back({state, p, step_factor});
  return run(requests);
}

void Responses::find_randomness() {
  std::vector<RunRequest> requests;
  for (std::size_t p = 0; p < points_.size(); ++p)
    for (std::uint64_t s = 0; s < 2; ++s)
      requests.push_back({.point = static_cast<int>(p), .effects = {}, .nuisances = {}, .seed = experiment_.seed + s});
  const auto results = simulator_.run(requests);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const RunResult &a = results[2 * p], &b = results[2 * p + 1];
    if (!a.failure.empty() && !b.failure.empty())
      throw Error(ExitCode::usage, "point \"" + experiment_.points[p].id + "\": the base model does not run: " + a.failure);
    for (std::size_t k = 0; k < a.values.size() && k < b.values.size(); ++k)
      base_is_random_ = base_is_random_ || (a.values[k] != b.values[k] && !(std::isnan(a.values[k]) && std::isnan(b.values[k])));
  }
  // Enough seeds for a spread, few enough that some hundred states fit the budget.
  seeds_of_random_ = std::clamp(experiment_.max_runs / (60 * static_cast<int>(points_.size())), 2, most_seeds);
}

void Responses::find_scatter() {
  std::vector<Request> requests;
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) requests.push_back({base(), p, 1, most_seeds});
  std::vector<Eigen::VectorXd> found;
  for (const Response& response : run(requests)) found.push_back(response.scatter);
  scatter_of_base_ = std::move(found);
}

void Responses::note_rows_left_out(std::size_t point, const Response& answer) {
  struct Left {
    int n = 0, of = 0;
    double from = std::numeric_limits<double>::infinity();
  };
  std::map<int, Left> all;  // by observable
  const std::vector<Row>& rows = points_[point].rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].kind != Row::Kind::path) {
      if (!std::isfinite(answer.value[static_cast<Eigen::Index>(i)]))
        notes_.push_back(experiment_.observables[static_cast<std::size_t>(rows[i].observable)].id + " at point " +
                         experiment_.points[point].id +
                         " is not compared, for the runs have no such number. If it is the time of an event after the end of the runs, "
                         "raise [time] end_s "
                         "of the case, or set kind = \"lognormal\": the run then counts as a time later than its end.");
      continue;
    }
    Left& left = all[rows[i].observable];
    ++left.of;
    if (!std::isfinite(answer.value[static_cast<Eigen::Index>(i)])) ++left.n, left.from = std::min(left.from, rows[i].begin);
  }
  const double end = simulator_.run_end(static_cast<int>(point));
  for (const auto& [observable, left] : all) {
    if (left.n == 0) continue;
    notes_.push_back(experiment_.observables[static_cast<std::size_t>(observable)].id + " at point " + experiment_.points[point].id + ": " +
                     std::to_string(left.n) + " of " + std::to_string(left.of) + " rows, from " + number_text(left.from) +
                     " s on, are not compared, for the runs have no number there" +
                     (left.from > end ? "; they end at " + number_text(end) + " s: raise [time] end_s of the case." : "."));
  }
}

// Rows that the base model has no number for (it left before, it was not retained) cannot be compared.
void Responses::leave_out_rows_without_answer(const std::vector<Response>& answers) {
  for (std::size_t p = 0; p < points_.size(); ++p) {
    note_rows_left_out(p, answers[p]);
    PointSummary& point = points_[p];
    std::vector<Row> rows;
    std::vector<int> kept, kept_of_all;
    for (int i = 0; i < static_cast<int>(point.rows.size()); ++i) {
      if (!std::isfinite(answers[p].value[i])) continue;
      if (i < point.n_gaussian) kept.push_back(i);
      kept_of_all.push_back(i), rows.push_back(std::move(point.rows[i]));
    }
    if (!scatter_of_base_.empty()) scatter_of_base_[p] = Eigen::VectorXd(scatter_of_base_[p](kept_of_all));
    for (auto& [unit, by_point] : in_right_units_) {
      InRightUnits& right = by_point[p];
      right.covariance = Eigen::MatrixXd(right.covariance(kept, kept));
      for (std::size_t i = 0; i < kept_of_all.size(); ++i)
        right.spread_noise_u[i] = right.spread_noise_u[static_cast<std::size_t>(kept_of_all[i])];
      right.spread_noise_u.resize(kept_of_all.size());
    }
    point.covariance = Eigen::MatrixXd(point.covariance(kept, kept));
    point.rows = std::move(rows), point.n_gaussian = static_cast<int>(kept.size());
  }
}

namespace {

/// f(row), the row with the noise that it has under the response's mistake of a unit.
template <class Function>
double with_row(const PointSummary& point, const Response& response, int i, const Function& f) {
  const Row& row = point.rows[static_cast<std::size_t>(i)];
  if (row.kind != Row::Kind::spread || response.spread_noise_u.empty()) return f(row);
  Row in_right_units = row;
  in_right_units.noise_u = response.spread_noise_u[static_cast<std::size_t>(i)];
  return f(in_right_units);
}

}  // namespace

Eigen::VectorXd residual(const PointSummary& point, const Response& response, const Eigen::LLT<Eigen::MatrixXd>& covariance) {
  const int n = static_cast<int>(point.rows.size()), g = point.n_gaussian;
  // A number that the run should have but lacks counts as five standard uncertainties off.
  constexpr double missing = 5;
  Eigen::VectorXd r(n);
  for (int i = 0; i < n; ++i) {
    const Row& row = point.rows[i];
    const double model = response.value[i];
    const bool later = !response.later.empty() && response.later[i];
    if (later && std::none_of(row.censored.begin(), row.censored.end(), [](bool c) { return !c; }))
      r[i] = 0;  // neither the tests nor the runs came to it
    else if (later)
      r[i] = deviance_residual(row, std::max(model, row.value), response.n_runs, response.scatter[i]);
    else if (!std::isfinite(model))
      r[i] = is_gaussian(row) ? missing * row.u : missing;
    else
      r[i] = is_gaussian(row) ? row.value - model : with_row(point, response, i, [&](const Row& one) {
        const bool is_counted = one.kind == Row::Kind::event || one.kind == Row::Kind::count;
        return deviance_residual(one, model, is_counted ? response.n_answers : response.n_runs, response.scatter[i]);
      });
  }
  if (g > 0) r.head(g) = covariance.matrixL().solve(r.head(g)).eval();
  return r;
}

double log_variance_ratio(const PointSummary& point, const Response& response) {
  double sum = 0;
  for (int i = point.n_gaussian; i < static_cast<int>(point.rows.size()); ++i)
    if (std::isfinite(response.value[i]))
      sum += std::log(with_row(point, response, i, [&](const Row& row) {
        return variance_ratio(row, response.value[i], response.n_runs, response.scatter[i]);
      }));
  return sum;
}

}  // namespace snag
