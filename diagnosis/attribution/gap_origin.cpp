#include "diagnosis/attribution/gap_origin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr double inherited_share = 0.5;  // of the gap that may stay when it is called inherited
constexpr double seen_in_mean = 2;       // means are compared, so that of the cell has to show the gap, in standard uncertainties

struct Fitted {
  Eigen::VectorXd value;       // coefficients at the time asked for
  Eigen::MatrixXd covariance;  // inflated where the polynomial does not describe the samples
};

/// Polynomial about a time of what an observable is off by, measured less simulated, by generalized least squares over the rows of its path
/// nearest to it: as many as the polynomial describes.
class LocalPolynomial {
 public:
  LocalPolynomial(const PointSummary& point, const Response& base, int observable, double time, int degree)
      : point_(point), base_(base), time_(time), k_(degree + 1) {
    for (int i = 0; i < point.n_gaussian; ++i)
      if (point.rows[i].kind == Row::Kind::path && point.rows[i].observable == observable) rows_.push_back(i);
    const auto off = [&](int i) { return std::abs(0.5 * (point.rows[i].begin + point.rows[i].end) - time); };
    std::stable_sort(rows_.begin(), rows_.end(), [&](int a, int b) { return off(a) < off(b); });
  }

  /// Nothing if there are too few samples.
  std::optional<Fitted> fit() const {
    const Eigen::Index fewest = k_ + 1;
    for (Eigen::Index n = std::min(std::ssize(rows_), most_samples); n >= fewest; --n) {
      constexpr double described = 0.1;
      const auto [fitted, p] = fit(n);
      if (p > described || n == fewest) return fitted;
    }
    return {};
  }

 private:
  static constexpr std::ptrdiff_t most_samples = 8;

  /// Over n rows; and p of their chi2.
  std::pair<Fitted, double> fit(Eigen::Index n) const {
    Eigen::MatrixXd X(n, k_), C(n, n);
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Row& row = point_.rows[rows_[i]];
      // The row is the mean over its bin: so are the powers of time.
      const double t = 0.5 * (row.begin + row.end) - time_, width = row.end - row.begin, m = static_cast<double>(row.slots.size());
      const std::array<double, 3> powers = {1, t, t * t + (m > 1 ? width * width / 12 * (m + 1) / (m - 1) : 0)};
      for (Eigen::Index j = 0; j < k_; ++j) X(i, j) = powers.at(j);
      y[i] = row.value - base_.value[rows_[i]];
      for (Eigen::Index j = 0; j < n; ++j) C(i, j) = point_.covariance(rows_[i], rows_[j]);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(C);
    const Eigen::MatrixXd A = factor.matrixL().solve(X);
    const Eigen::VectorXd b = factor.matrixL().solve(y);
    const Eigen::LLT<Eigen::MatrixXd> normal(A.transpose() * A);
    Fitted fitted{normal.solve(A.transpose() * b), normal.solve(Eigen::MatrixXd::Identity(k_, k_))};
    const double chi2 = (b - A * fitted.value).squaredNorm(), freedom = static_cast<double>(n - k_);
    fitted.covariance *= std::max(1.0, chi2 / freedom);
    return {fitted, chi_squared_tail(chi2, freedom)};
  }

  const PointSummary& point_;
  const Response& base_;
  double time_;
  Eigen::Index k_;
  std::vector<int> rows_;
};

/// What the simulated state is off by at an entry, and what may be wrong with that: one standard deviation each.
struct Entry {
  Restart state;
  std::vector<Restart> others;  // the state with one of them
};

int observable_of(const Experiment& experiment, const std::string& id) {
  for (std::size_t o = 0; o < experiment.observables.size(); ++o)
    if (experiment.observables[o].id == id && experiment.observables[o].kind == Observable::Kind::gaussian) return static_cast<int>(o);
  return -1;
}

std::optional<Entry> measured_state(const Experiment& experiment, const PointSummary& point, const Response& base, double time) {
  Entry entry{{.time = time}, {}};
  struct Shift {
    int axis;
    double position, velocity;
  };
  std::vector<Shift> shifts;
  for (int d = 0; d < 3; ++d) {
    const std::string axis(1, "xyz"[d]);
    const auto place = LocalPolynomial(point, base, observable_of(experiment, axis), time, 2).fit();
    const auto speed = LocalPolynomial(point, base, observable_of(experiment, "v" + axis), time, 1).fit();
    if (place) entry.state.position[d] = place->value[0];
    const bool by_place = place && (!speed || place->covariance(1, 1) < speed->covariance(0, 0));
    if (by_place) {
      entry.state.velocity[d] = place->value[1];
      const Eigen::MatrixXd L = place->covariance.topLeftCorner(2, 2).llt().matrixL();
      shifts.push_back({d, L(0, 0), L(1, 0)}), shifts.push_back({d, 0, L(1, 1)});
    } else if (speed) {
      entry.state.velocity[d] = speed->value[0];
      shifts.push_back({d, 0, std::sqrt(speed->covariance(0, 0))});
      if (place) shifts.push_back({d, std::sqrt(place->covariance(0, 0)), 0});
    }
  }
  if (shifts.empty()) return {};
  for (const Shift& shift : shifts) {
    Restart moved = entry.state;
    moved.position[shift.axis] += shift.position, moved.velocity[shift.axis] += shift.velocity;
    entry.others.push_back(moved);
  }
  return entry;
}

/// Runs from one entry: from the state as measured, with twice the step, with each shift of it, with each input moved.
class RunsFromEntry {
 public:
  RunsFromEntry(const Responses& model, int point, const Entry& entry) {
    const auto add = [&](const Restart& restart, int nuisance, double step_factor, double share) {
      State state = model.base();
      state.restart = restart;
      if (nuisance >= 0) state.nuisances[nuisance] = nuisance_step;
      requests.push_back({state, point, step_factor}), share_.push_back(share);
    };
    add(entry.state, -1, 1, 0);
    add(entry.state, -1, 2, 1);
    for (const Restart& other : entry.others) add(other, -1, 1, 1);
    for (int j = 0; j < static_cast<int>(model.nuisances().size()); ++j) {
      const FreeNuisance& nuisance = model.nuisances()[j];
      if (nuisance.of_data || nuisance.bias_observable >= 0 || !model.acts_at(j, point)) continue;
      add(entry.state, j, 1, 1 / nuisance_step);
    }
  }

  std::vector<Responses::Request> requests;

  /// E' and the square of its uncertainty by steps, state and inputs, of the mean over some rows.
  std::pair<double, double> gap(const PointSummary& point, const std::vector<int>& rows, std::span<const Response> responses) const {
    const auto mean = [&](const Response& response) {
      double sum = 0;
      for (const int i : rows) sum += response.value[i] - point.rows[i].value;
      return sum / static_cast<double>(rows.size());
    };
    const double E = mean(responses[0]);
    double square = 0;
    for (std::size_t r = 1; r < responses.size(); ++r) {
      const double change = (mean(responses[r]) - E) * share_[r];
      square += change * change;
    }
    return {E, square};
  }

 private:
  std::vector<double> share_;  // what a request's change stands for, in standard uncertainties
};

class OriginJudge {
 public:
  OriginJudge(Responses& model, const Fitter& fitter) : model_(model), fitter_(fitter) {}

  void judge(std::vector<GapCell>& cells) {
    for (GapCell& cell : cells)
      if (cell.significant && !std::isnan(cell.window[0]) && std::abs(cell.z) > seen_in_mean) restart(cell);
    const auto born = benjamini_hochberg(p_values_);
    for (std::size_t i = 0; i < judged_.size(); ++i)
      judged_[i]->origin = born[i] ? GapOrigin::born : gone_[i] ? GapOrigin::inherited : GapOrigin::undecided;
  }

 private:
  struct Runs {
    RunsFromEntry asked;
    std::vector<Response> answers;
  };

  void restart(GapCell& cell) {
    const auto& points = model_.experiment().points;
    const int p =
        static_cast<int>(std::find_if(points.begin(), points.end(), [&](const auto& o) { return o.id == cell.point; }) - points.begin());
    const std::vector<int> rows = rows_after_others(cell, model_.points()[p]);
    if (rows.empty() || !model_.restarts(p)) return;
    const Runs* runs = runs_from(p, cell.window[0]);
    if (!runs) return;
    const PointSummary& point = model_.points()[p];
    const auto [E, of_model] = runs->asked.gap(point, rows, runs->answers);
    if (!std::isfinite(E + of_model)) return;
    cell.restart_z = E / std::sqrt(point.covariance(rows, rows).mean() + of_model + cell.u_S * cell.u_S);
    judged_.push_back(&cell), p_values_.push_back(two_sided_p(cell.restart_z));
    gone_.push_back(std::abs(E) < inherited_share * std::abs(cell.simulated - cell.measured));
  }

  /// Rows of the cell; none if its window is the first of the path.
  std::vector<int> rows_after_others(const GapCell& cell, const PointSummary& point) const {
    std::vector<int> rows;
    bool first = true;
    for (int i = 0; i < point.n_gaussian; ++i) {
      const Row& row = point.rows[i];
      if (row.kind != Row::Kind::path || model_.experiment().observables[row.observable].id != cell.observable) continue;
      first = first && row.begin >= cell.window[0];
      if (row.begin >= cell.window[0] && row.end <= cell.window[1]) rows.push_back(i);
    }
    return first ? std::vector<int>() : rows;
  }

  /// Null where the data do not hold the state, or the budget does not hold the runs.
  const Runs* runs_from(int p, double time) {
    const auto found = runs_.find({p, time});
    if (found != runs_.end()) return &found->second;
    const auto training = std::find(model_.training().begin(), model_.training().end(), p) - model_.training().begin();
    const auto entry = measured_state(model_.experiment(), model_.points()[p], fitter_.base().responses[training], time);
    if (!entry) return nullptr;
    RunsFromEntry asked(model_, p, *entry);
    if (model_.runs_left() < static_cast<int>(asked.requests.size()) * model_.n_seeds(model_.base())) return nullptr;
    std::vector<Response> answers = model_.run(asked.requests);
    return &runs_.emplace(std::pair{p, time}, Runs{std::move(asked), std::move(answers)}).first->second;
  }

  Responses& model_;
  const Fitter& fitter_;
  std::map<std::pair<int, double>, Runs> runs_;  // by point and time of the entry
  std::vector<GapCell*> judged_;
  std::vector<double> p_values_;
  std::vector<bool> gone_;  // most of the gap, by the restart
};

}  // namespace

void judge_origins(Responses& model, const Fitter& fitter, std::vector<GapCell>& cells) { OriginJudge(model, fitter).judge(cells); }

}  // namespace snag
