#include "diagnosis/screening.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/statistics.hpp"

namespace snag {

double probe_strength(const Effect& effect) {
  const double wanted = std::abs(effect.mean) > 0.5 * effect.sd ? effect.mean : effect.mean + effect.sd;
  return std::clamp(wanted, effect.minimum, effect.maximum);
}

Screening::Screening(Responses& model, Fitter& fitter, const std::vector<int>& candidates, const Linearization& around)
    : model_(model), fitter_(fitter), around_(around) {
  const auto& training = model.training();
  std::vector<Responses::Request> requests;
  for (const int k : candidates) {
    State state = around_.state;
    const bool there = std::any_of(state.effects.begin(), state.effects.end(), [&](const auto& e) { return e.first == k; });
    if (there) continue;
    state.effects.emplace_back(k, probe_strength(model.effects()[k]));
    candidates_.push_back(k);
    for (const int p : training) requests.push_back({state, p});
  }
  // Effects that are already there are moved by half a standard deviation.
  for (std::size_t e = 0; e < around_.state.effects.size(); ++e) {
    State state = around_.state;
    const Effect& effect = model.effects()[state.effects[e].first];
    double& theta = state.effects[e].second;
    theta = theta + 0.5 * effect.sd <= effect.maximum ? theta + 0.5 * effect.sd : std::max(effect.minimum, theta - 0.5 * effect.sd);
    for (const int p : training) requests.push_back({state, p});
  }
  const auto responses = model.run(requests);
  whitening_ = fitter.whiten(around_);
  rho_ = fitter.residual(around_.responses, whitening_);
  nuisances_ = fitter.nuisance_columns(around_, whitening_);
  const Eigen::Index m = nuisances_.cols();
  nuisance_precision_inverse_ =
      (nuisances_.transpose() * nuisances_ + Eigen::MatrixXd::Identity(m, m)).llt().solve(Eigen::MatrixXd::Identity(m, m));
  std::size_t next = 0;
  const auto take = [&](int k) {
    for (std::size_t p = 0; p < training.size(); ++p) {
      probed_[k].push_back(responses[next]);
      signatures_[k].push_back(
          (responses[next++].value - around_.responses[p].value).unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }));
    }
    columns_[k] = column(k, whitening_, rho_);
  };
  for (const int k : candidates_) take(k);
  for (const auto& [k, theta] : around_.state.effects) take(k);
}

Eigen::VectorXd Screening::column(int k, const Whitening& whitening, const Eigen::VectorXd& rho) const {
  const Effect& effect = model_.effects()[k];
  double moved = probe_strength(effect);
  for (const auto& [there, theta] : around_.state.effects)
    if (there == k)
      moved = theta + 0.5 * effect.sd <= effect.maximum ? 0.5 * effect.sd : std::max(effect.minimum, theta - 0.5 * effect.sd) - theta;
  return (fitter_.residual(probed_.at(k), whitening) - rho) * (effect.sd / moved);
}

Screened Screening::screen(const Hypothesis& hypothesis) const {
  const int k = static_cast<int>(hypothesis.effects.size()), m = static_cast<int>(nuisances_.cols());
  Screened result{hypothesis, 0, Eigen::VectorXd(k)};
  LinearModel linear;
  linear.prior = Eigen::VectorXd::Zero(k + m);
  linear.prior.tail(m) = -around_.state.nuisances;
  linear.lower.resize(k), linear.upper.resize(k);
  Eigen::VectorXd present = Eigen::VectorXd::Zero(k);
  for (int e = 0; e < k; ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    for (const auto& [there, theta] : around_.state.effects)
      if (there == hypothesis.effects[e]) present[e] = theta;
    linear.prior[e] = (effect.mean - present[e]) / effect.sd;
    linear.lower[e] = (effect.minimum - present[e]) / effect.sd, linear.upper[e] = (effect.maximum - present[e]) / effect.sd;
  }
  // First without an error of form, then with it: it follows the strength.
  Linearization at = around_;
  std::vector<double> evidence;
  const auto judge = [&](const Whitening& whitening, bool first) {
    linear.rho = first ? rho_ : fitter_.residual(around_.responses, whitening);
    linear.J.resize(linear.rho.size(), k + m);
    for (int e = 0; e < k; ++e)
      linear.J.col(e) = first ? columns_.at(hypothesis.effects[e]) : column(hypothesis.effects[e], whitening, linear.rho);
    linear.J.rightCols(m) = first ? nuisances_ : fitter_.nuisance_columns(around_, whitening);
    const LinearSolution solution = solve(linear);
    evidence.push_back(solution.log_evidence - 0.5 * whitening.log_determinant);
    for (int e = 0; e < k && evidence.back() >= *std::max_element(evidence.begin(), evidence.end()); ++e)
      result.theta[e] = present[e] + model_.effects()[hypothesis.effects[e]].sd * solution.d[e];
  };
  judge(whitening_, true);
  if (k == 0) {
    result.log_evidence = evidence.front();
    return result;
  }
  for (int e = 0; e < k; ++e) {
    if (present[e] != 0) continue;
    at.parts.emplace_back();
    const double share = result.theta[e] / probe_strength(model_.effects()[hypothesis.effects[e]]);
    for (const Eigen::VectorXd& s : signatures_.at(hypothesis.effects[e])) at.parts.back().push_back(share * s);
  }
  evidence.clear();
  for (const double form : form_errors) judge(fitter_.whiten(at, form), false);
  result.log_evidence = log_sum_exp(evidence) - std::log(static_cast<double>(form_errors.size()));
  return result;
}

double Screening::projected(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  return a.dot(b) - (nuisances_.transpose() * a).dot(nuisance_precision_inverse_ * (nuisances_.transpose() * b));
}

double Screening::detectability(int k) const {
  const Effect& effect = model_.effects()[k];
  return std::sqrt(std::max(0.0, projected(columns_.at(k), columns_.at(k)))) * std::abs(probe_strength(effect)) / effect.sd;
}

double Screening::cosine(int a, int b) const {
  const double norm = std::sqrt(std::max(0.0, projected(columns_.at(a), columns_.at(a)) * projected(columns_.at(b), columns_.at(b))));
  return norm > 0 ? projected(columns_.at(a), columns_.at(b)) / norm : 0;
}

double Screening::sham_rate(std::uint64_t seed) const {
  const int m = static_cast<int>(nuisances_.cols());
  const auto first = fitter_.first_rows();
  const auto evidence = [&](const Eigen::VectorXd& own, const Effect& effect) {
    LinearModel linear{rho_, Eigen::MatrixXd(rho_.size(), 1 + m), Eigen::VectorXd::Zero(1 + m), {}, {}};
    linear.J.col(0) = own, linear.J.rightCols(m) = nuisances_;
    linear.prior[0] = effect.mean / effect.sd;
    linear.lower = Eigen::VectorXd::Constant(1, effect.minimum / effect.sd),
    linear.upper = Eigen::VectorXd::Constant(1, effect.maximum / effect.sd);
    return solve(linear).log_evidence;
  };
  NormalNumbers random(seed);
  double best = solve(LinearModel{rho_, nuisances_, Eigen::VectorXd::Zero(m), Eigen::VectorXd(), Eigen::VectorXd()}).log_evidence;
  std::vector<double> sham;
  for (const int k : candidates_) {
    const Effect& effect = model_.effects()[k];
    best = std::max(best, evidence(columns_.at(k), effect));
    for (int repeat = 0; repeat < 3; ++repeat) {
      Eigen::VectorXd own = columns_.at(k);
      for (std::size_t p = 0; p + 1 < first.size(); ++p) {
        auto part = own.segment(first[p], first[p + 1] - first[p]);
        part = (random.uniform() < 0.5 ? -1 : 1) * part.reverse().eval();
      }
      sham.push_back(evidence(own, effect));
    }
  }
  return sham.empty() ? 0
                      : static_cast<double>(std::count_if(sham.begin(), sham.end(), [&](double e) { return e > best; })) /
                            static_cast<double>(sham.size());
}

}  // namespace snag
