// Of Responses: mistakes of inputs and of the measurement, as effects beside those of the simulator.
#include <algorithm>
#include <map>

#include "diagnosis/fitting/response.hpp"

namespace snag {

void Responses::find_mistakes(const std::vector<Response>& answers) {
  const auto add = [&](std::vector<Mistake> found) {
    for (Mistake& mistake : found) effects_.push_back(mistake.effect), mistakes_.push_back(std::move(mistake));
  };
  add(mistakes_of_inputs(experiment_, simulator_.nuisances()));
  add(mistakes_of_measurement(experiment_));
  add(mistakes_of_groups(experiment_));
  struct Ratio {
    double both = 0, own = 0;     // products of data and simulation, of simulation with itself
    double logarithm = 0, n = 0;  // sum of ln(data/simulation) of lognormal quantities
  };
  std::map<std::string, Ratio> ratios;  // by unit
  for (const int p : training_)
    for (std::size_t i = 0; i < points_[p].rows.size(); ++i) {
      const Row& row = points_[p].rows[i];
      const Observable& observable = experiment_.observables[static_cast<std::size_t>(row.observable)];
      const double simulated = answers[p].value[static_cast<Eigen::Index>(i)];
      if (row.kind == Row::Kind::spread || answers[p].later[i] || !std::isfinite(simulated) || !std::isfinite(row.u)) continue;
      Ratio& ratio = ratios[observable.unit];
      if (observable.kind == Observable::Kind::gaussian) ratio.both += row.value * simulated, ratio.own += simulated * simulated;
      if (observable.kind == Observable::Kind::lognormal) ratio.logarithm += row.value - simulated, ratio.n += 1;
    }
  for (const auto& [unit, ratio] : ratios) {
    std::vector<Mistake> found = mistakes_of_unit(experiment_, unit, ratio.own > 0 ? ratio.both / ratio.own : 0);
    if (found.empty() && ratio.n > 0) found = mistakes_of_unit(experiment_, unit, std::exp(ratio.logarithm / ratio.n));
    add(std::move(found));
  }
  find_noise_in_right_units();
}

// Who writes numbers down in another unit F times smaller still states noise and bias in the unit that is named: y ~ N(F f, F^2 C'), with
// C' of the numbers y/F, whose repeats tell the noise as those of any data do.
void Responses::find_noise_in_right_units() {
  for (int k = 0; k < static_cast<int>(effects_.size()); ++k) {
    if (mistake(k) == nullptr || mistake(k)->kind != Mistake::Kind::unit) continue;
    const Mistake& made = *mistake(k);
    Experiment right = experiment_;
    for (Datum& d : right.data)
      if (std::count(made.observables.begin(), made.observables.end(), d.observable) > 0) d.value /= made.factor, d.sd /= made.factor;
    for (PointSummary& point : summarize(right, simulator_, has_spread_)) {
      Eigen::VectorXd factor = Eigen::VectorXd::Ones(std::ssize(point.rows));
      std::vector<double> spread_noise_u;
      for (Eigen::Index i = 0; i < factor.size(); ++i) {
        const Row& row = point.rows[static_cast<std::size_t>(i)];
        const bool logarithm = experiment_.observables[static_cast<std::size_t>(row.observable)].kind == Observable::Kind::lognormal;
        if (!logarithm && std::count(made.observables.begin(), made.observables.end(), row.observable) > 0) factor[i] = made.factor;
        spread_noise_u.push_back(factor[i] * row.noise_u);
      }
      const auto gaussian = factor.head(point.n_gaussian).asDiagonal();
      in_right_units_[k].push_back({gaussian * point.covariance * gaussian, std::move(spread_noise_u)});
    }
  }
}

double Responses::factor_of_unit(const State& state, int observable) const {
  double factor = 1;
  for (const auto& [k, theta] : state.effects) {
    const Mistake* made = mistake(k);
    if (made == nullptr || made->kind != Mistake::Kind::unit || theta == 0) continue;
    if (std::count(made->observables.begin(), made->observables.end(), observable) > 0) factor *= made->factor;
  }
  return factor;
}

// Rows of different observables have nothing in common, and an observable has one unit.
Eigen::MatrixXd Responses::covariance_in_right_units(const State& state, int point) const {
  const PointSummary& summary = points_[static_cast<std::size_t>(point)];
  Eigen::MatrixXd covariance;
  for (const auto& [k, theta] : state.effects) {
    const Mistake* made = mistake(k);
    if (made == nullptr || made->kind != Mistake::Kind::unit || theta == 0) continue;
    if (covariance.size() == 0) covariance = summary.covariance;
    const Eigen::MatrixXd& own = in_right_units_.at(k)[static_cast<std::size_t>(point)].covariance;
    const auto changes = [&](int row) {
      const int o = summary.rows[static_cast<std::size_t>(row)].observable;
      return std::count(made->observables.begin(), made->observables.end(), o) > 0;
    };
    for (int i = 0; i < summary.n_gaussian; ++i)
      for (int j = 0; j < summary.n_gaussian; ++j)
        if (changes(i) && changes(j)) covariance(i, j) = own(i, j);
  }
  return covariance;
}

std::vector<double> Responses::spread_noise_in_right_units(const State& state, int point) const {
  for (const auto& [k, theta] : state.effects) {
    const Mistake* made = mistake(k);
    if (made != nullptr && made->kind == Mistake::Kind::unit && theta != 0)
      return in_right_units_.at(k)[static_cast<std::size_t>(point)].spread_noise_u;
  }
  return {};
}

const Mistake* Responses::mistake(int effect) const {
  const auto first = static_cast<int>(simulator_.effects().size()), end = first + static_cast<int>(mistakes_.size());
  return effect < first || effect >= end ? nullptr : &mistakes_[static_cast<std::size_t>(effect - first)];
}

bool Responses::changes_runs(int effect) const {
  const Mistake* made = mistake(effect);
  return made == nullptr || made->kind == Mistake::Kind::input;
}

// What the data would say of these runs if the mistakes of the state were made.
std::vector<double> Responses::mismeasure(const State& state, int point, std::span<RunResult> results) const {
  std::vector<double> largest;
  for (const auto& [k, theta] : state.effects) {
    const Mistake* made = mistake(k);
    if (made == nullptr || made->kind == Mistake::Kind::input || theta == 0) continue;
    if (!made->points.empty() && std::count(made->points.begin(), made->points.end(), point) == 0) continue;
    for (RunResult& result : results) {
      if (!result.failure.empty()) continue;
      const std::vector<double> u = snag::mismeasure(*made, theta, simulator_.slots(point), result.values);
      largest.resize(u.size(), 0);
      for (std::size_t s = 0; s < u.size(); ++s) largest[s] = std::max(largest[s], u[s]);
    }
  }
  return largest;
}

}  // namespace snag
