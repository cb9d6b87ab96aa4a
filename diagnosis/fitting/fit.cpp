#include "diagnosis/fitting/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

// A hypothesis that does not describe the data, so that half its chi2 is far above half the number of rows, need not be known to a
// hundredth of a nat.
double coarseness(double objective, Eigen::Index n_rows) {
  constexpr double share = 0.3;  // at a misfit of 100 nats: to 0.3 nats, turn by turn to 3
  return std::max(1.0, share * (objective - static_cast<double>(n_rows)));
}

// The form of each effect that leads.
std::vector<int> leads_of(const Fit& fit) {
  std::vector<int> leads = fit.at.state.forms;
  leads.resize(fit.hypothesis.effects.size(), 0);
  return leads;
}

}  // namespace

std::string name_of(const Hypothesis& hypothesis, const std::vector<Effect>& effects) {
  if (hypothesis.effects.empty()) return "none";
  std::string name;
  for (const int k : hypothesis.effects) name += (name.empty() ? "" : "+") + effects[k].name;
  return name;
}

double clear_of_nothing(const Fit& fit, std::size_t effect, const std::vector<Effect>& effects) {
  const auto e = static_cast<Eigen::Index>(effect);
  const double strength = std::abs(fit.theta[e]) / fit.theta_sd[e];
  std::vector<Eigen::Index> held, rest;
  const auto others = other_forms(fit.at.state, effects);
  const Eigen::Index n = fit.solution.precision.rows(), first_share = n - fit.at.state.shares.size();
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool own = i >= first_share && others[static_cast<std::size_t>(i - first_share)].effect == effect;
    (own ? held : rest).push_back(i);
  }
  if (held.empty()) return strength;
  const Eigen::MatrixXd given_forms =
      fit.solution.precision(rest, rest).llt().solve(Eigen::MatrixXd::Identity(std::ssize(rest), std::ssize(rest)));
  const double squared = strength * strength * fit.solution.covariance(e, e) / given_forms(e, e);  // strengths come first: rest[e] is e
  const Eigen::VectorXd shares = (fit.solution.d - fit.linear.prior)(held);
  return std::sqrt(std::max(0.0, squared - shares.squaredNorm()));
}

int Fitter::runs_of_fit(int n_effects) const {
  std::set<std::pair<std::string, double>> moved;  // what is common and what is a point's own of one input take the same runs
  for (const FreeNuisance& nuisance : model_.nuisances()) moved.emplace(nuisance.name, nuisance.u);
  return (10 + 8 * n_effects + static_cast<int>(moved.size())) * model_.n_seeds(model_.base());
}

int Fitter::runs_left() const {
  // A small budget goes to the question which effect it is.
  const int for_withheld = 2 * static_cast<int>(model_.withheld().size()) * runs_of_fit(0);
  return model_.runs_left() - std::min(for_withheld, model_.experiment().max_runs / 5);
}

// x: strengths in prior standard deviations, nuisances, shares of other forms.
State Fitter::state_of(const Fit& fit, const Eigen::VectorXd& x) const {
  const auto k = static_cast<Eigen::Index>(fit.hypothesis.effects.size()), m = static_cast<Eigen::Index>(model_.nuisances().size());
  State state{{}, x.segment(k, m), fit.at.state.forms, x.tail(x.size() - k - m)};
  for (Eigen::Index e = 0; e < k; ++e) {
    const int index = fit.hypothesis.effects[static_cast<std::size_t>(e)];
    const Effect& effect = model_.effects()[index];
    state.effects.emplace_back(index, std::clamp(effect.mean + effect.sd * x[e], effect.minimum, effect.maximum));
  }
  return state;
}

double Fitter::objective(const Fit& fit, const Eigen::VectorXd& x, const std::vector<Response>& responses) const {
  return 0.5 * residual(responses, fit.whitening).squaredNorm() + 0.5 * x.squaredNorm();
}

// Levenberg-Marquardt within the ranges of the strengths, x = (t, nu).
void Fitter::descend(Fit& fit, Eigen::VectorXd& x, int iterations) {
  const int k = static_cast<int>(fit.hypothesis.effects.size());
  double damping = 0, value = objective(fit, x, fit.at.responses);
  bool as_promised = false;  // by the last step: then its derivatives are good for one more
  for (int i = 0; i < iterations; ++i) {
    LinearModel& linear = fit.linear;
    linear.rho = residual(fit.at.responses, fit.whitening);
    if (!as_promised) linear.J.leftCols(k) = effect_columns(fit.hypothesis, fit.at, fit.whitening);
    linear.prior = -x;
    for (int e = 0; e < k; ++e) {
      const Effect& effect = model_.effects()[fit.hypothesis.effects[e]];
      linear.lower[e] = (effect.minimum - effect.mean) / effect.sd - x[e],
      linear.upper[e] = (effect.maximum - effect.mean) / effect.sd - x[e];
    }
    bool accepted = false, slow = false;
    for (int trial = 0; trial < 4 && !accepted; ++trial) {
      Eigen::MatrixXd JtJ = linear.J.transpose() * linear.J;
      JtJ.diagonal() *= 1 + damping;
      const LinearSolution step =
          solve(JtJ, linear.J.transpose() * linear.rho, linear.rho.squaredNorm(), linear.prior, linear.lower, linear.upper);
      const double promised = value - step.objective;
      constexpr double converged = 0.01;  // nats
      if (promised < converged * coarseness(value, linear.rho.size())) return;
      const Eigen::VectorXd moved = x + step.d;
      const State state = state_of(fit, moved);
      auto responses = run_near(fit.at, state);
      const double reached = objective(fit, moved, responses);
      // Where nothing runs there is no fit, however far off the state before was.
      const bool runs = std::none_of(responses.begin(), responses.end(), [](const Response& r) { return !r.failure.empty(); });
      if (runs && reached < value) {
        if (value - reached > 0.5 * promised) damping *= 0.1;
        as_promised = value - reached > 0.8 * promised;
        slow = value - reached < 0.1 * (value - static_cast<double>(linear.rho.size()));
        x = moved, value = reached, accepted = true;
        fit.at.state = state, fit.at.responses = std::move(responses);
      } else {
        damping = std::max(10 * damping, 0.1);
      }
    }
    // Far off and slow: these derivatives do not lead further.
    if (!accepted || (slow && value > 2 * static_cast<double>(linear.rho.size()))) return;
  }
}

// The linear model at the fitted state with one error of form, or with the likeliest (form_error < 0), and its evidence.
void Fitter::linearize_at_fit(Fit& fit, const Eigen::VectorXd& x, double form_error) {
  const int k = static_cast<int>(fit.hypothesis.effects.size()), m = static_cast<int>(model_.nuisances().size());
  if (form_error < 0 && k > 0) {
    std::vector<double> evidence;
    double best = -std::numeric_limits<double>::infinity(), best_form = widest_form_error;
    for (const double form : form_errors) {
      linearize_at_fit(fit, x, form);
      evidence.push_back(fit.log_evidence);
      if (fit.log_evidence > best) best = fit.log_evidence, best_form = form;
    }
    linearize_at_fit(fit, x, best_form);
    fit.log_evidence = log_sum_exp(evidence) - std::log(static_cast<double>(form_errors.size()));
    return;
  }
  fit.form_error = std::max(0.0, form_error);
  fit.whitening = whiten(fit.at, fit.form_error);
  fit.linear.rho = residual(fit.at.responses, fit.whitening);
  fit.linear.J.resize(fit.first_row.back(), x.size());
  fit.linear.J.leftCols(k) = effect_columns(fit.hypothesis, fit.at, fit.whitening);
  fit.linear.J.middleCols(k, m) = nuisance_columns(fit.at, fit.whitening);
  fit.linear.J.rightCols(x.size() - k - m) = share_columns(fit.at, fit.whitening);
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

Fit Fitter::fit_with_leads(const Hypothesis& hypothesis, const Eigen::VectorXd& start, const std::vector<int>& forms) {
  const int k = static_cast<int>(hypothesis.effects.size()), m = static_cast<int>(model_.nuisances().size());
  Fit fit;
  fit.hypothesis = hypothesis, fit.first_row = first_rows();
  fit.at.state.forms = forms;
  for (const int effect : hypothesis.effects) fit.at.state.effects.emplace_back(effect, 0);
  const int s = static_cast<int>(other_forms(fit.at.state, model_.effects()).size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(k + m + s);
  for (int e = 0; e < k; ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    x[e] = (std::clamp(start[e], effect.minimum, effect.maximum) - effect.mean) / effect.sd;
  }
  fit.linear.lower.resize(k), fit.linear.upper.resize(k);
  // The covariance and the derivatives by nuisances and shares depend on the state: first those of the base, then those of the fit, until
  // a turn brings nothing.
  constexpr int turns = 4, steps = 4;
  constexpr double gain = 0.1;  // nats
  for (int turn = 0; turn < turns; ++turn) {
    if (turn > 1 && runs_left() < runs_of_fit(k) * static_cast<int>(model_.training().size())) break;
    double before = std::numeric_limits<double>::infinity();
    if (turn == 0) {
      fit.at = k == 0 ? base_ : start_from_base(state_of(fit, x));
      fit.whitening = whiten(fit.at, widest_form_error);
    } else {
      fit.at = linearize(fit.at.state, hypothesis);
      linearize_at_fit(fit, x, -1);
      before = objective(fit, x, fit.at.responses);
    }
    fit.linear.J.resize(fit.first_row.back(), x.size());
    fit.linear.J.middleCols(k, m) = nuisance_columns(turn == 0 ? base_ : fit.at, fit.whitening);
    fit.linear.J.rightCols(s) = share_columns(fit.at, fit.whitening);
    const Linearization at = fit.at;
    const Eigen::VectorXd from = x;
    descend(fit, x, steps);
    if (fit.at.state.shares.size() > 0) fit.at.responses = model_.run(fit.at.state, model_.training());
    const double reached = objective(fit, x, fit.at.responses);
    if (reached > before) {  // what the shares add had changed too much on the way
      fit.at = at, x = from;
      break;
    }
    if (turn > 0 && before - reached < gain * coarseness(reached, fit.first_row.back())) break;
    // What is off by more than four times the expected chi2 and does not come near fast will not come near.
    if (turn > 0 && reached > 2 * fit.first_row.back() && reached > 0.5 * before) break;
  }
  linearize_at_fit(fit, x, -1);
  fit.theta.resize(k), fit.theta_sd.resize(k);
  for (int e = 0; e < k; ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    fit.theta[e] = effect.mean + effect.sd * (x[e] + fit.solution.d[e]);
    fit.theta_sd[e] = effect.fixed ? 0 : effect.sd * std::sqrt(fit.solution.covariance(e, e));
  }
  return fit;
}

// Where another form has most of the share, it leads.
Fit Fitter::fit_with_best_leads(const Hypothesis& hypothesis, const Eigen::VectorXd& start, const std::vector<int>& forms) {
  Fit fit = fit_with_leads(hypothesis, start, forms);
  const auto others = other_forms(fit.at.state, model_.effects());
  std::vector<int> leads = leads_of(fit);
  std::vector<double> most(leads.size(), 0.5);
  for (std::size_t s = 0; s < others.size(); ++s) {
    const double share = others[s].sd * fit.at.state.shares[static_cast<Eigen::Index>(s)];
    const bool may_lead = others[s].form < model_.effects()[hypothesis.effects[others[s].effect]].n_forms;
    if (may_lead && share > most[others[s].effect]) most[others[s].effect] = share, leads[others[s].effect] = others[s].form;
  }
  if (leads == leads_of(fit) || !may_fit(hypothesis)) return fit;
  Fit other = fit_with_leads(hypothesis, fit.theta, leads);
  return other.log_evidence > fit.log_evidence ? other : fit;
}

Fit Fitter::fit(const Hypothesis& hypothesis, const Eigen::VectorXd& start, const std::vector<int>& forms) {
  Fit best = fit_with_best_leads(hypothesis, start, forms);
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e)
    if (model_.effects()[hypothesis.effects[e]].exclusive_forms) fit_exclusive_forms(best, e);
  return best;
}

void Fitter::fit_exclusive_forms(Fit& best, std::size_t e) {
  constexpr double hopeless = 50;  // nats: half of them may be an error of the linear model
  const Fit first = best;
  const auto runs_with = [&](const std::vector<int>& leads) {
    State state = lead_of(first.at.state);
    state.forms = leads;
    return model_.run(state, model_.training());
  };
  const Eigen::VectorXd of_first = residual(runs_with(leads_of(first)), first.whitening);
  LinearModel linear = first.linear;
  std::vector<double> evidence{first.log_evidence};
  for (int form = 0; form < model_.effects()[first.hypothesis.effects[e]].n_forms && may_fit(first.hypothesis); ++form) {
    std::vector<int> leads = leads_of(first);
    if (leads[e] == form) continue;
    leads[e] = form;
    linear.rho = first.linear.rho + residual(runs_with(leads), first.whitening) - of_first;
    const double reached = first.log_evidence + solve(linear).log_evidence - first.solution.log_evidence;
    if (linear.rho.isApprox(first.linear.rho, 1e-9)) {
      evidence.push_back(first.log_evidence);
    } else if (reached < first.log_evidence - hopeless) {
      evidence.push_back(reached);
    } else {
      Fit with_form = fit_with_best_leads(first.hypothesis, first.theta, leads);
      evidence.push_back(with_form.log_evidence);
      if (with_form.log_evidence > best.log_evidence) best = std::move(with_form);
    }
  }
  best.log_evidence = log_sum_exp(evidence) - std::log(static_cast<double>(evidence.size()));
}

bool Fitter::may_fit(const Hypothesis& hypothesis) const {
  return runs_left() >= runs_of_fit(static_cast<int>(hypothesis.effects.size())) * static_cast<int>(model_.training().size());
}

}  // namespace snag
