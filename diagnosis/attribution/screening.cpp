#include "diagnosis/attribution/screening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

double probe_strength(const Effect& effect) {
  const double wanted = std::abs(effect.mean) > 0.5 * effect.sd ? effect.mean : effect.mean + effect.sd;
  return std::clamp(wanted, effect.minimum, effect.maximum);
}

bool Screening::present(int effect) const {
  return std::any_of(around_.state.effects.begin(), around_.state.effects.end(), [&](const auto& e) { return e.first == effect; });
}

Screening::Screening(Responses& model, Fitter& fitter, const std::vector<int>& candidates, const Linearization& around)
    : model_(model), fitter_(fitter), around_(around) {
  const auto& training = model.training();
  std::vector<Responses::Request> requests;
  for (const int k : candidates) {
    if (present(k)) continue;
    candidates_.push_back(k);
    const Effect& effect = model.effects()[k];
    for (int form = 0; form < effect.n_forms + effect.n_deviations; ++form) {
      State state = around_.state;
      state.forms.resize(state.effects.size(), 0);
      state.effects.emplace_back(k, probe_strength(effect)), state.forms.push_back(form);
      for (const int p : training) requests.push_back({state, p});
    }
  }
  // Effects that are already there are moved by half a standard deviation.
  const std::size_t n_added = requests.size();
  for (std::size_t e = 0; e < around_.state.effects.size(); ++e) {
    State state = around_.state;
    const Effect& effect = model.effects()[state.effects[e].first];
    double& theta = state.effects[e].second;
    theta += step_within_range(effect, theta, 0.5 * effect.sd);
    for (const int p : training) requests.push_back({state, p});
  }
  auto responses = model.run(requests);
  // An emulated fit has no runs of these seeds: of them the signature is the difference, not of the draws of chance.
  if (model.base_is_random()) around_.responses = model.run(around_.state, training);
  fitter.mirror_failed(around_.state, around_.responses, std::span(requests).subspan(n_added), std::span(responses).subspan(n_added),
                       [&](const auto& down) { return model.run(down); });
  metric_ = metric(widest_form_error), exact_ = metric(0);
  weak_form_.emplace(model, metric_.whitening);
  std::size_t next = 0;
  const auto take = [&](int k, int n_forms) {
    for (int form = 0; form < n_forms; ++form) {
      probed_[k].emplace_back(), signatures_[k].emplace_back();
      for (std::size_t p = 0; p < training.size(); ++p) {
        probed_[k].back().push_back(responses[next]);
        signatures_[k].back().push_back(finite(responses[next++].value - around_.responses[p].value));
      }
      columns_[k].push_back(column(k, form, metric_.whitening, metric_.rho));
    }
  };
  for (const int k : candidates_) take(k, model.effects()[k].n_forms + model.effects()[k].n_deviations);
  for (const auto& [k, theta] : around_.state.effects) take(k, 1);
}

Eigen::VectorXd Screening::column(int k, int form, const Whitening& whitening, const Eigen::VectorXd& rho) const {
  const Effect& effect = model_.effects()[k];
  double moved = probe_strength(effect);
  for (const auto& [there, theta] : around_.state.effects)
    if (there == k) moved = step_within_range(effect, theta, 0.5 * effect.sd);
  if (moved == 0) return Eigen::VectorXd::Zero(rho.size());
  return (fitter_.residual(probed_.at(k)[static_cast<std::size_t>(form)], whitening) - rho) * (effect.sd / moved);
}

// Other forms at the strengths where the linear model puts the effects, and those of the effects around which was screened.
Eigen::MatrixXd Screening::share_columns(const Screened& screened, const Whitening& whitening, const Eigen::VectorXd& rho) const {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t e = 0; e < screened.hypothesis.effects.size(); ++e) {
    const int k = screened.hypothesis.effects[e];
    if (present(k)) continue;
    const Eigen::VectorXd lead = column(k, screened.forms[e], whitening, rho);
    const double strength = screened.theta[static_cast<Eigen::Index>(e)] / model_.effects()[k].sd;
    const State added{{{k, 0}}, {}, {screened.forms[e]}};
    for (const OtherForm& other : other_forms(added, model_.effects()))
      columns.push_back(other.sd * strength * (column(k, other.form, whitening, rho) - lead));
  }
  const Eigen::MatrixXd around = fitter_.share_columns(around_, whitening);
  Eigen::MatrixXd all(rho.size(), around.cols() + static_cast<Eigen::Index>(columns.size()));
  all.leftCols(around.cols()) = around;
  for (std::size_t c = 0; c < columns.size(); ++c) all.col(around.cols() + static_cast<Eigen::Index>(c)) = columns[c];
  return all;
}

Screened Screening::screen(const Hypothesis& hypothesis) const {
  return screen_from({strengths_there(hypothesis), around_.state.nuisances, around_.responses}, hypothesis);
}

Screened Screening::screen_in_place_of(const std::string& input, int added, const Hypothesis& hypothesis) const {
  const Screened first = screen(hypothesis);
  const auto at = std::find(hypothesis.effects.begin(), hypothesis.effects.end(), added) - hypothesis.effects.begin();
  const int form = first.forms[static_cast<std::size_t>(at)];
  Start start{strengths_there(hypothesis), around_.state.nuisances, {}};
  Eigen::VectorXd missing = Eigen::VectorXd::Zero(metric_.rho.size());
  for (Eigen::Index j = 0; j < start.nuisances.size(); ++j) {
    if (model_.nuisances()[static_cast<std::size_t>(j)].name != input) continue;
    missing += start.nuisances[j] * metric_.nuisances.col(j);
    start.nuisances[j] = 0;
  }
  const Effect& effect = model_.effects()[added];
  const Eigen::VectorXd& own = columns_.at(added)[static_cast<std::size_t>(form)];
  const std::vector<Response> leading = model_.run(lead_of(around_.state), model_.training());
  double& theta = start.strengths[at];
  constexpr int steps = 2;  // the first is linear, the second mends what is not
  for (int step = 0; step < steps; ++step) {
    theta = std::clamp(theta + effect.sd * own.dot(missing) / own.squaredNorm(), effect.minimum, effect.maximum);
    if (!std::isfinite(theta) || theta == 0) return {hypothesis, -std::numeric_limits<double>::infinity(), first.theta, first.forms};
    State state = lead_of(around_.state);
    state.nuisances = start.nuisances, state.forms.resize(state.effects.size(), 0);
    state.effects.emplace_back(added, theta), state.forms.push_back(form);
    start.responses = model_.run(state, model_.training());
    for (std::size_t p = 0; p < leading.size(); ++p)
      start.responses[p] = beside(around_.responses[p], leading[p], std::move(start.responses[p]));
    missing = metric_.rho - fitter_.residual(start.responses, metric_.whitening);
  }
  return screen_from(start, hypothesis);
}

Screened Screening::screen_from(const Start& start, const Hypothesis& hypothesis) const {
  const auto k = static_cast<Eigen::Index>(hypothesis.effects.size());
  Screened result{hypothesis, -std::numeric_limits<double>::infinity(), Eigen::VectorXd(k), std::vector<int>(hypothesis.effects.size(), 0)};
  LinearModel linear = linear_model(hypothesis, start);
  screen_leads(start, linear, result);
  if (k == 0) return result;
  screen_shares(start, linear, result);
  // Forms of the effects that are there.
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e)
    for (std::size_t i = 0; i < around_.state.effects.size(); ++i)
      if (around_.state.effects[i].first == hypothesis.effects[e]) result.forms[e] = around_.state.form(i);
  return result;
}

/// theta of each effect at the state around which was screened; 0 of those that are added.
Eigen::VectorXd Screening::strengths_there(const Hypothesis& hypothesis) const {
  Eigen::VectorXd there = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(hypothesis.effects.size()));
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e)
    for (const auto& [index, theta] : around_.state.effects)
      if (index == hypothesis.effects[e]) there[static_cast<Eigen::Index>(e)] = theta;
  return there;
}

/// Prior and bounds of the strengths and the nuisances; the columns of the strengths are still to be filled.
LinearModel Screening::linear_model(const Hypothesis& hypothesis, const Start& start) const {
  const int k = static_cast<int>(hypothesis.effects.size()), m = static_cast<int>(metric_.nuisances.cols());
  LinearModel linear;
  linear.prior = Eigen::VectorXd::Zero(k + m);
  linear.prior.segment(k, m) = -start.nuisances;
  linear.lower.resize(k), linear.upper.resize(k);
  for (int e = 0; e < k; ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    const double there = start.strengths[e];
    linear.prior[e] = (effect.mean - there) / effect.sd;
    linear.lower[e] = (effect.minimum - there) / effect.sd, linear.upper[e] = (effect.maximum - there) / effect.sd;
  }
  linear.rho = fitter_.residual(start.responses, metric_.whitening), linear.J.resize(metric_.rho.size(), k + m),
  linear.J.rightCols(m) = metric_.nuisances;
  return linear;
}

/// Without an error of form, each form in the lead by turns: evidence, forms and strengths of the best.
void Screening::screen_leads(const Start& start, LinearModel& linear, Screened& result) const {
  const std::vector<int>& effects = result.hypothesis.effects;
  const int k = static_cast<int>(effects.size());
  std::vector<int> leads(effects.size(), 0);
  for (bool more = true; more;) {
    for (int e = 0; e < k; ++e) linear.J.col(e) = columns_.at(effects[e])[static_cast<std::size_t>(leads[static_cast<std::size_t>(e)])];
    const LinearSolution solution = solve(linear);
    const double evidence = solution.log_evidence - 0.5 * metric_.whitening.log_determinant;
    if (evidence > result.log_evidence) {
      result.log_evidence = evidence, result.forms = leads;
      for (int e = 0; e < k; ++e) result.theta[e] = start.strengths[e] + model_.effects()[effects[e]].sd * solution.d[e];
    }
    more = false;
    for (std::size_t e = 0; e < leads.size() && !more; ++e) {
      more = ++leads[e] < (present(effects[e]) ? 1 : model_.effects()[effects[e]].n_forms);
      if (!more) leads[e] = 0;
    }
  }
}

/// With an error of form, and with shares of the forms that do not lead: both follow the strength that is known without them.
void Screening::screen_shares(const Start& start, LinearModel& linear, Screened& result) const {
  const Screened first = result;
  const std::vector<int>& effects = first.hypothesis.effects;
  const int k = static_cast<int>(effects.size()), m = static_cast<int>(metric_.nuisances.cols());
  Linearization at = around_;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    if (present(effects[e])) continue;
    at.parts.emplace_back();
    const double share = first.theta[static_cast<Eigen::Index>(e)] / probe_strength(model_.effects()[effects[e]]);
    for (const Eigen::VectorXd& s : signatures_.at(effects[e])[static_cast<std::size_t>(first.forms[e])])
      at.parts.back().push_back(share * s);
  }
  std::vector<double> evidence;
  for (const double form : form_errors) {
    const Whitening whitening = fitter_.whiten(at, form);
    const Eigen::VectorXd rho = fitter_.residual(around_.responses, whitening);
    linear.rho = fitter_.residual(start.responses, whitening);
    const Eigen::MatrixXd shares = share_columns(first, whitening, rho);
    const auto s = static_cast<int>(shares.cols());
    linear.J.resize(linear.rho.size(), k + m + s), linear.prior.conservativeResize(k + m + s);
    linear.prior.tail(s).setZero();
    // Shares that the fit around which was screened has already; effects that are there come before those that are added.
    const Eigen::Index given = std::min<Eigen::Index>(s, around_.state.shares.size());
    linear.prior.segment(k + m, given) = -around_.state.shares.head(given);
    for (int e = 0; e < k; ++e) linear.J.col(e) = column(effects[e], first.forms[static_cast<std::size_t>(e)], whitening, rho);
    linear.J.middleCols(k, m) = fitter_.nuisance_columns(around_, whitening);
    linear.J.rightCols(s) = shares;
    const LinearSolution solution = solve(linear);
    evidence.push_back(solution.log_evidence - 0.5 * whitening.log_determinant);
    for (int e = 0; e < k && evidence.back() >= *std::max_element(evidence.begin(), evidence.end()); ++e)
      result.theta[e] = start.strengths[e] + model_.effects()[effects[e]].sd * solution.d[e];
  }
  result.log_evidence = log_sum_exp(evidence) - std::log(static_cast<double>(form_errors.size()));
}

double Screening::weak_gain(int k) const {
  const auto& weak = *weak_form_;
  if (weak.size() == 0) return 0;
  const auto m = metric_.nuisances.cols();
  LinearModel none{weak(metric_.rho), Eigen::MatrixXd(weak.size(), m), -around_.state.nuisances, {}, {}};
  for (Eigen::Index j = 0; j < m; ++j) none.J.col(j) = weak(metric_.nuisances.col(j));
  const double without = solve(none).log_evidence;
  const Effect& effect = model_.effects()[k];
  double best = -std::numeric_limits<double>::infinity();
  for (const Eigen::VectorXd& own : columns_.at(k)) {
    LinearModel with{none.rho, Eigen::MatrixXd(weak.size(), 1 + m), Eigen::VectorXd(1 + m), {}, {}};
    with.J << weak(own), none.J;
    with.prior << effect.mean / effect.sd, none.prior;
    with.lower = Eigen::VectorXd::Constant(1, effect.minimum / effect.sd);
    with.upper = Eigen::VectorXd::Constant(1, effect.maximum / effect.sd);
    best = std::max(best, solve(with).log_evidence - without);
  }
  return best;
}

Screening::Metric Screening::metric(double form_error) const {
  Metric metric;
  metric.whitening = fitter_.whiten(around_, form_error);
  metric.rho = fitter_.residual(around_.responses, metric.whitening);
  metric.nuisances = fitter_.nuisance_columns(around_, metric.whitening);
  const Eigen::MatrixXd& J = metric.nuisances;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(J.cols(), J.cols());
  metric.nuisance_covariance = (J.transpose() * J + one).llt().solve(one);
  return metric;
}

double Screening::Metric::product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  return a.dot(b) - (nuisances.transpose() * a).dot(nuisance_covariance * (nuisances.transpose() * b));
}

double Screening::detectability(int k) const {
  const Effect& effect = model_.effects()[k];
  return change_of_one_sd(k) * std::abs(probe_strength(effect)) / effect.sd;
}

double Screening::change_of_one_sd(int k) const {
  const Eigen::VectorXd own = column(k, 0, exact_.whitening, exact_.rho);
  return std::sqrt(std::max(0.0, exact_.product(own, own)));
}

bool Screening::changes_runs(int k) const {
  const auto& forms = signatures_.at(k);
  return std::any_of(forms.begin(), forms.end(), [](const auto& points) {
    return std::any_of(points.begin(), points.end(), [](const Eigen::VectorXd& s) { return !s.isZero(0); });
  });
}

std::string Screening::failure(int k) const {
  const auto& leading = probed_.at(k).front();
  return std::all_of(leading.begin(), leading.end(), [](const Response& r) { return !r.failure.empty(); }) ? leading.front().failure : "";
}

double Screening::cosine(int a, int b) const {
  const Eigen::VectorXd &of_a = columns_.at(a).front(), &of_b = columns_.at(b).front();
  const double norm = std::sqrt(std::max(0.0, metric_.product(of_a, of_a) * metric_.product(of_b, of_b)));
  return norm > 0 ? metric_.product(of_a, of_b) / norm : 0;
}

double Screening::placebo_rate(std::uint64_t seed) const {
  const int m = static_cast<int>(metric_.nuisances.cols());
  const auto first = fitter_.first_rows();
  const auto evidence = [&](const Eigen::VectorXd& own, const Effect& effect) {
    LinearModel linear{metric_.rho, Eigen::MatrixXd(metric_.rho.size(), 1 + m), Eigen::VectorXd::Zero(1 + m), {}, {}};
    linear.J.col(0) = own, linear.J.rightCols(m) = metric_.nuisances;
    linear.prior[0] = effect.mean / effect.sd;
    linear.lower = Eigen::VectorXd::Constant(1, effect.minimum / effect.sd),
    linear.upper = Eigen::VectorXd::Constant(1, effect.maximum / effect.sd);
    return solve(linear).log_evidence;
  };
  NormalNumbers random(seed);
  double best =
      solve(LinearModel{metric_.rho, metric_.nuisances, Eigen::VectorXd::Zero(m), Eigen::VectorXd(), Eigen::VectorXd()}).log_evidence;
  std::vector<double> placebo;
  for (const int k : candidates_) {
    const Effect& effect = model_.effects()[k];
    best = std::max(best, evidence(columns_.at(k).front(), effect));
    for (int repeat = 0; repeat < 3; ++repeat) {
      Eigen::VectorXd own = columns_.at(k).front();
      for (std::size_t p = 0; p + 1 < first.size(); ++p) {
        auto part = own.segment(first[p], first[p + 1] - first[p]);
        part = (random.uniform() < 0.5 ? -1 : 1) * part.reverse().eval();
      }
      placebo.push_back(evidence(own, effect));
    }
  }
  return placebo.empty() ? 0
                         : static_cast<double>(std::count_if(placebo.begin(), placebo.end(), [&](double e) { return e > best; })) /
                               static_cast<double>(placebo.size());
}

}  // namespace snag
