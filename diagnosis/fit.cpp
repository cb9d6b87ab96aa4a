#include "diagnosis/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis/statistics.hpp"

namespace snag {

namespace {

/// Over what shares of the duration an error of form keeps its sign, and how much of its variance each has.
struct FormLength {
  double length, share;
};
constexpr std::array form_lengths{FormLength{1.0 / 3, 0.8}, FormLength{1.0 / 15, 0.2}};

// Matern correlation of order 3/2.
double matern(double distance) {
  const double r = std::sqrt(3.0) * distance;
  return (1 + r) * std::exp(-r);
}

// Size of an effect's contribution up to each row: an error of form does not vanish where the contribution crosses zero.
Eigen::VectorXd envelope(const PointSummary& point, const Eigen::VectorXd& part) {
  Eigen::VectorXd size(point.n_gaussian);
  double sum = 0;
  int n = 0;
  for (int i = 0; i < point.n_gaussian; ++i) {
    if (i == 0 || point.rows[i].observable != point.rows[i - 1].observable) sum = 0, n = 0;
    sum += part[i] * part[i], ++n;
    size[i] = std::sqrt(std::max(part[i] * part[i], sum / n));
  }
  return size;
}

Eigen::VectorXd finite(const Eigen::VectorXd& values) {
  return values.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

double time_of(const Row& row) { return 0.5 * (row.begin + row.end); }

void add_form_error(const PointSummary& point, const Eigen::VectorXd& part, double form_error, Eigen::MatrixXd& C) {
  const Eigen::VectorXd size = form_error * envelope(point, part);
  const double duration = std::max(point.duration, 1e-300);
  for (int i = 0; i < point.n_gaussian; ++i) {
    for (int j = 0; j < point.n_gaussian; ++j) {
      if (point.rows[i].observable != point.rows[j].observable) continue;
      const double apart = i == j ? 0 : std::abs(time_of(point.rows[i]) - time_of(point.rows[j])) / duration;
      for (const FormLength& form : form_lengths) C(i, j) += size[i] * size[j] * form.share * matern(apart / form.length);
    }
  }
}

// Scatter of the runs over their number, and over the number of replicates where these are too few to show it themselves. Few seeds give
// the size of the scatter but not its shape: it is taken as sd_i sd_j exp(-|t_i - t_j|/tau), tau from neighbouring rows.
void add_scatter(const PointSummary& point, const Response& response, Eigen::MatrixXd& C) {
  const double n = static_cast<double>(response.paths.cols());
  const Eigen::MatrixXd S = response.paths * response.paths.transpose() / (n - 1);
  constexpr int few_replicates = 3;
  for (int begin = 0, end = 0; begin < point.n_gaussian; begin = end) {
    double next = 0, own = 0, step = 0;
    for (end = begin; end < point.n_gaussian && point.rows[end].observable == point.rows[begin].observable; ++end) {
      if (end == begin) continue;
      next += S(end, end - 1), own += 0.5 * (S(end, end) + S(end - 1, end - 1));
      step += (time_of(point.rows[end]) - time_of(point.rows[end - 1])) / std::max(1, point.n_gaussian - 1);
    }
    const double correlation = own > 0 ? std::clamp(next / own, 0.03, 0.999) : 0.03;
    const double tau = -(step > 0 ? step * (point.n_gaussian - 1) / std::max(1, end - begin - 1) : 1) / std::log(correlation);
    for (int i = begin; i < end; ++i) {
      for (int j = begin; j < end; ++j) {
        const int replicates = std::min(point.rows[i].n_replicates, point.rows[j].n_replicates);
        const double share = 1 / n + (replicates < few_replicates ? 1.0 / replicates : 0);
        const double apart = i == j ? 0 : std::abs(time_of(point.rows[i]) - time_of(point.rows[j])) / tau;
        C(i, j) += share * std::sqrt(S(i, i) * S(j, j)) * std::exp(-apart);
      }
    }
  }
}

}  // namespace

Eigen::MatrixXd model_covariance(const PointSummary& point, const Response& response, const Eigen::VectorXd& numerical_error,
                                 const std::vector<const Eigen::VectorXd*>& parts, double form_error) {
  const int g = point.n_gaussian;
  Eigen::MatrixXd C = point.covariance;
  // The error of the step has one sign over a run, and is not known better than by a tenth.
  const Eigen::VectorXd e = numerical_error.head(g);
  C += e * e.transpose();
  C.diagonal() += (0.1 * e).cwiseAbs2();
  if (response.paths.cols() > 1) add_scatter(point, response, C);
  for (const Eigen::VectorXd* part : parts) add_form_error(point, *part, form_error, C);
  // Row by row: rows have units of their own.
  C.diagonal() = (1 + 1e-9) * C.diagonal().array() + 1e-300;
  return C;
}

std::string name_of(const Hypothesis& hypothesis, const std::vector<Effect>& effects) {
  if (hypothesis.effects.empty()) return "none";
  std::string name;
  for (const int k : hypothesis.effects) name += (name.empty() ? "" : "+") + effects[k].name;
  return name;
}

Fitter::Fitter(Responses& model) : model_(model) { base_ = linearize(model.base(), {}); }

std::vector<int> Fitter::first_rows() const {
  std::vector<int> first{0};
  for (const int p : model_.training()) first.push_back(first.back() + static_cast<int>(model_.points()[p].rows.size()));
  return first;
}

std::vector<Eigen::VectorXd> Fitter::numerical_error(const State& state, const std::vector<Response>& responses) {
  const auto coarse = model_.run(state, model_.training(), 2);
  std::vector<Eigen::VectorXd> errors;
  std::vector<Responses::Request> again;
  for (std::size_t p = 0; p < coarse.size(); ++p) {
    if (coarse[p].failed) again.push_back({state, model_.training()[p], 0.5});
  }
  // A step that is too coarse to run at all: then from half the step.
  const auto fine = again.empty() ? std::vector<Response>{} : model_.run(again);
  std::size_t next = 0;
  for (std::size_t p = 0; p < coarse.size(); ++p) {
    Eigen::VectorXd error = coarse[p].failed ? Eigen::VectorXd(2 * (responses[p].value - fine[next].value))
                                             : Eigen::VectorXd(coarse[p].value - responses[p].value);
    if (coarse[p].failed) ++next;
    errors.push_back(finite(error));
  }
  return errors;
}

Linearization Fitter::linearize(const State& state, const Hypothesis& hypothesis) {
  Linearization at;
  at.state = state;
  const auto& training = model_.training();
  at.responses = model_.run(state, training);
  std::vector<Responses::Request> requests;
  for (std::size_t j = 0; j < model_.nuisances().size(); ++j) {
    State moved = state;
    moved.nuisances[static_cast<Eigen::Index>(j)] += nuisance_step;
    for (const int p : training)
      if (model_.acts_at(static_cast<int>(j), p)) requests.push_back({moved, p});
  }
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
    State without = state;
    without.effects[e].second = 0;
    for (const int p : training) requests.push_back({without, p});
  }
  auto responses = model_.run(requests);
  std::size_t next = 0;
  for (std::size_t j = 0; j < model_.nuisances().size(); ++j) {
    at.by_nuisance.emplace_back(training.size());
    for (std::size_t p = 0; p < training.size(); ++p)
      if (model_.acts_at(static_cast<int>(j), training[p])) at.by_nuisance[j][p] = std::move(responses[next++]);
  }
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
    at.parts.emplace_back();
    for (std::size_t p = 0; p < training.size(); ++p) at.parts[e].push_back(finite(at.responses[p].value - responses[next++].value));
  }
  at.numerical_error = numerical_error(state, at.responses);
  return at;
}

Whitening Fitter::whiten(const Linearization& at, double form_error) const {
  Whitening whitening;
  for (std::size_t p = 0; p < model_.training().size(); ++p) {
    std::vector<const Eigen::VectorXd*> parts;
    for (const auto& part : at.parts) parts.push_back(&part[p]);
    const PointSummary& point = model_.points()[model_.training()[p]];
    const Eigen::MatrixXd C = model_covariance(point, at.responses[p], at.numerical_error[p], parts, form_error);
    whitening.factor.emplace_back(C);
    const Eigen::MatrixXd& L = whitening.factor.back().matrixLLT();
    whitening.log_ratio.push_back(log_variance_ratio(point, at.responses[p]));
    whitening.log_determinant +=
        whitening.log_ratio.back() + 2 * L.diagonal().array().log().sum() + point.n_gaussian * std::log(2 * std::numbers::pi);
  }
  return whitening;
}

Eigen::VectorXd Fitter::residual(const std::vector<Response>& responses, const Whitening& whitening) const {
  const auto first = first_rows();
  Eigen::VectorXd rho(first.back());
  for (std::size_t p = 0; p < responses.size(); ++p)
    rho.segment(first[p], first[p + 1] - first[p]) =
        snag::residual(model_.points()[model_.training()[p]], responses[p], whitening.factor[p]);
  return rho;
}

Eigen::MatrixXd Fitter::nuisance_columns(const Linearization& at, const Whitening& whitening) const {
  const auto first = first_rows();
  const Eigen::VectorXd rho = residual(at.responses, whitening);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(first.back(), static_cast<Eigen::Index>(at.by_nuisance.size()));
  for (std::size_t j = 0; j < at.by_nuisance.size(); ++j) {
    for (std::size_t p = 0; p < at.responses.size(); ++p) {
      if (at.by_nuisance[j][p].value.size() == 0) continue;
      const int begin = first[p], n = first[p + 1] - begin;
      J.col(static_cast<Eigen::Index>(j)).segment(begin, n) =
          (snag::residual(model_.points()[model_.training()[p]], at.by_nuisance[j][p], whitening.factor[p]) - rho.segment(begin, n)) /
          nuisance_step;
    }
  }
  return J;
}

State Fitter::state_of(const Hypothesis& hypothesis, const Eigen::VectorXd& t, const Eigen::VectorXd& nuisances) const {
  State state{{}, nuisances};
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    state.effects.emplace_back(hypothesis.effects[e],
                               std::clamp(effect.mean + effect.sd * t[static_cast<Eigen::Index>(e)], effect.minimum, effect.maximum));
  }
  return state;
}

Eigen::MatrixXd Fitter::effect_columns(const Hypothesis& hypothesis, const State& state, const std::vector<Response>& responses,
                                       const Whitening& whitening) {
  const auto& training = model_.training();
  // Where runs are random their difference needs a step that stands out.
  const double size = model_.base_is_random() ? 0.5 : 0.1;
  std::vector<Responses::Request> requests;
  std::vector<double> steps;
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    State moved = state;
    const double sign = state.effects[e].second + size * effect.sd > effect.maximum ? -1 : 1;
    moved.effects[e].second = std::max(effect.minimum, state.effects[e].second + sign * size * effect.sd);
    steps.push_back((moved.effects[e].second - state.effects[e].second) / effect.sd);
    for (const int p : training) requests.push_back({moved, p});
  }
  const auto moved = model_.run(requests);
  const Eigen::VectorXd rho = residual(responses, whitening);
  Eigen::MatrixXd J(rho.size(), static_cast<Eigen::Index>(steps.size()));
  for (std::size_t e = 0; e < steps.size(); ++e) {
    const std::vector<Response> own(moved.begin() + e * training.size(), moved.begin() + (e + 1) * training.size());
    J.col(static_cast<Eigen::Index>(e)) = (residual(own, whitening) - rho) / steps[e];
  }
  return J;
}

double Fitter::objective(const Fit& fit, const Eigen::VectorXd& x, const std::vector<Response>& responses) const {
  return 0.5 * residual(responses, fit.whitening).squaredNorm() + 0.5 * x.squaredNorm();
}

// Levenberg-Marquardt within the ranges of the strengths, x = (t, nu).
void Fitter::descend(Fit& fit, Eigen::VectorXd& x, int iterations) {
  const int k = static_cast<int>(fit.hypothesis.effects.size());
  double damping = 0, value = objective(fit, x, fit.at.responses);
  for (int i = 0; i < iterations; ++i) {
    LinearModel& linear = fit.linear;
    linear.rho = residual(fit.at.responses, fit.whitening);
    linear.J.leftCols(k) = effect_columns(fit.hypothesis, fit.at.state, fit.at.responses, fit.whitening);
    linear.prior = -x;
    for (int e = 0; e < k; ++e) {
      const Effect& effect = model_.effects()[fit.hypothesis.effects[e]];
      linear.lower[e] = (effect.minimum - effect.mean) / effect.sd - x[e],
      linear.upper[e] = (effect.maximum - effect.mean) / effect.sd - x[e];
    }
    bool accepted = false;
    for (int trial = 0; trial < 4 && !accepted; ++trial) {
      Eigen::MatrixXd JtJ = linear.J.transpose() * linear.J;
      JtJ.diagonal() *= 1 + damping;
      const LinearSolution step =
          solve(JtJ, linear.J.transpose() * linear.rho, linear.rho.squaredNorm(), linear.prior, linear.lower, linear.upper);
      const double promised = value - step.objective;
      constexpr double converged = 0.01;  // nats
      if (promised < converged) return;
      const Eigen::VectorXd moved = x + step.d;
      const State state = state_of(fit.hypothesis, moved.head(k), moved.tail(moved.size() - k));
      auto responses = model_.run(state, model_.training());
      const double reached = objective(fit, moved, responses);
      if (reached < value) {
        if (value - reached > 0.5 * promised) damping *= 0.1;
        x = moved, value = reached, accepted = true;
        fit.at.state = state, fit.at.responses = std::move(responses);
      } else {
        damping = std::max(10 * damping, 0.1);
      }
    }
    if (!accepted) return;
  }
}

// A state of which only the runs themselves are done; what else is needed is taken from the base model.
Linearization Fitter::start_from_base(const State& state) {
  Linearization at;
  at.state = state;
  at.responses = model_.run(state, model_.training());
  at.numerical_error = base_.numerical_error;
  for (std::size_t e = 0; e < state.effects.size(); ++e) {
    State without = state;
    without.effects[e].second = 0;
    const auto responses = model_.run(without, model_.training());
    at.parts.emplace_back();
    for (std::size_t p = 0; p < responses.size(); ++p) at.parts[e].push_back(finite(at.responses[p].value - responses[p].value));
  }
  return at;
}

// The linear model at the fitted state with one error of form, or with the likeliest (form_error < 0), and its evidence.
void Fitter::linearize_at_fit(Fit& fit, const Eigen::VectorXd& x, const Linearization& nuisances_at, double form_error) {
  const int k = static_cast<int>(fit.hypothesis.effects.size()), m = static_cast<int>(x.size()) - k;
  if (form_error < 0 && k > 0) {
    std::vector<double> evidence;
    double best = -std::numeric_limits<double>::infinity(), best_form = widest_form_error;
    for (const double form : form_errors) {
      linearize_at_fit(fit, x, nuisances_at, form);
      evidence.push_back(fit.log_evidence);
      if (fit.log_evidence > best) best = fit.log_evidence, best_form = form;
    }
    linearize_at_fit(fit, x, nuisances_at, best_form);
    fit.log_evidence = log_sum_exp(evidence) - std::log(static_cast<double>(form_errors.size()));
    return;
  }
  fit.form_error = std::max(0.0, form_error);
  fit.whitening = whiten(fit.at, fit.form_error);
  fit.linear.rho = residual(fit.at.responses, fit.whitening);
  fit.linear.J.resize(fit.first_row.back(), k + m);
  fit.linear.J.leftCols(k) = effect_columns(fit.hypothesis, fit.at.state, fit.at.responses, fit.whitening);
  fit.linear.J.rightCols(m) = nuisance_columns(nuisances_at, fit.whitening);
  fit.linear.prior = -x;
  for (int e = 0; e < k; ++e) {
    const Effect& effect = model_.effects()[fit.hypothesis.effects[e]];
    fit.linear.lower[e] = (effect.minimum - effect.mean) / effect.sd - x[e],
    fit.linear.upper[e] = (effect.maximum - effect.mean) / effect.sd - x[e];
  }
  fit.solution = solve(fit.linear);
  fit.log_evidence = fit.solution.log_evidence - 0.5 * fit.whitening.log_determinant;
  fit.residual = fit.linear.rho + fit.linear.J * fit.solution.d;
}

Fit Fitter::fit(const Hypothesis& hypothesis, const Eigen::VectorXd& start) {
  const int k = static_cast<int>(hypothesis.effects.size()), m = static_cast<int>(model_.nuisances().size());
  Fit fit;
  fit.hypothesis = hypothesis, fit.first_row = first_rows();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(k + m);
  for (int e = 0; e < k; ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    x[e] = (std::clamp(start[e], effect.minimum, effect.maximum) - effect.mean) / effect.sd;
  }
  fit.linear.lower.resize(k), fit.linear.upper.resize(k);
  fit.linear.J.resize(fit.first_row.back(), k + m);
  // The covariance and the derivatives by the nuisances depend on the state: first those of the base, then those of the fit.
  fit.at = k == 0 ? base_ : start_from_base(state_of(hypothesis, x.head(k), x.tail(m)));
  for (const bool from_base : {true, false}) {
    if (!from_base) fit.at = linearize(fit.at.state, hypothesis);
    const Linearization nuisances_at = from_base ? base_ : fit.at;
    if (!from_base) linearize_at_fit(fit, x, nuisances_at, -1);
    const double form = from_base ? widest_form_error : fit.form_error;
    fit.whitening = whiten(fit.at, form);
    fit.linear.J.rightCols(m) = nuisance_columns(nuisances_at, fit.whitening);
    descend(fit, x, from_base ? 4 : 2);
    if (!from_base) linearize_at_fit(fit, x, nuisances_at, -1);
  }
  fit.theta.resize(k), fit.theta_sd.resize(k);
  for (int e = 0; e < k; ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    fit.theta[e] = effect.mean + effect.sd * (x[e] + fit.solution.d[e]);
    fit.theta_sd[e] = effect.sd * std::sqrt(fit.solution.covariance(e, e));
  }
  return fit;
}

}  // namespace snag
