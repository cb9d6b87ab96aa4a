#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/fitting/fit.hpp"
#include "diagnosis/fitting/numerical_error.hpp"

namespace snag {

namespace {

/// Whether the origin has numbers that a run with something moved has not: the run failed, or ended before.
bool lacks_rows(const Response& moved, const Response& origin) {
  for (Eigen::Index i = 0; i < origin.value.size(); ++i)
    if (std::isfinite(origin.value[i]) && !std::isfinite(moved.value[i])) return true;
  return !moved.failure.empty();
}

/// Those rows as by the derivative on the other side, from a run that was moved back by `reach` steps; unchanged where it lacks them, too.
void fill_rows(Response& moved, const Response& origin, const Response& back, double reach) {
  const Eigen::VectorXd answered = moved.value;
  const bool has_failed = !moved.failure.empty();
  if (has_failed) moved = origin;
  for (Eigen::Index i = 0; i < origin.value.size(); ++i) {
    if (!has_failed && std::isfinite(answered[i])) continue;
    moved.value[i] = origin.value[i];
    if (back.failure.empty() && std::isfinite(back.value[i])) moved.value[i] += (origin.value[i] - back.value[i]) / reach;
  }
}

}  // namespace

double step_within_range(const Effect& effect, double theta, double wanted) {
  const double above = effect.maximum - theta, below = theta - effect.minimum;
  if (wanted <= above) return wanted;
  if (wanted <= below) return -wanted;
  return above >= below ? above : -below;
}

Fitter::Fitter(Responses& model) : model_(model) { base_ = linearize(model.base(), {}); }

std::vector<int> Fitter::first_rows() const {
  std::vector<int> first{0};
  for (const int p : model_.training()) first.push_back(first.back() + static_cast<int>(model_.points()[p].rows.size()));
  return first;
}

Linearization Fitter::linearize(const State& state, const Hypothesis& hypothesis) {
  Linearization at;
  at.state = state;
  const auto& training = model_.training();
  at.responses = at.origin = model_.run(state, training);
  const State leading = lead_of(state);
  const auto lead = model_.run(leading, training);
  std::vector<Responses::Request> requests;
  for (std::size_t j = 0; j < model_.nuisances().size(); ++j) {
    State moved = leading;
    moved.nuisances[static_cast<Eigen::Index>(j)] += nuisance_step;
    for (const int p : training)
      if (model_.acts_at(static_cast<int>(j), p)) requests.push_back({moved, p});
  }
  const std::size_t n_moved = requests.size();
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
    State without = leading;
    without.effects[e].second = 0;
    for (const int p : training) requests.push_back({without, p});
  }
  auto responses = model_.run(requests);
  mirror_failed(leading, lead, std::span(requests).first(n_moved), std::span(responses).first(n_moved),
                [this](const auto& down) { return model_.run(down); });
  std::size_t next = 0;
  for (std::size_t j = 0; j < model_.nuisances().size(); ++j) {
    at.by_nuisance.emplace_back(training.size());
    for (std::size_t p = 0; p < training.size(); ++p)
      if (model_.acts_at(static_cast<int>(j), training[p])) at.by_nuisance[j][p] = beside(at.responses[p], lead[p], responses[next++]);
  }
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
    at.parts.emplace_back();
    for (std::size_t p = 0; p < training.size(); ++p) at.parts[e].push_back(finite(lead[p].value - responses[next++].value));
  }
  add_shares(at);
  at.numerical_error = numerical_error(model_, leading, training, lead);
  return at;
}

void Fitter::mirror_failed(const State& origin, const std::vector<Response>& at_origin, std::span<const Responses::Request> requests,
                           std::span<Response> responses, const Runs& run) const {
  const auto& training = model_.training();
  const auto origin_of = [&](std::size_t i) -> const Response& {
    return at_origin[static_cast<std::size_t>(std::find(training.begin(), training.end(), requests[i].point) - training.begin())];
  };
  std::vector<Responses::Request> mirrored;
  std::vector<std::pair<std::size_t, double>> failed;  // its response, and its step over that of the request
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (!lacks_rows(responses[i], origin_of(i))) continue;
    Responses::Request down = requests[i];
    down.state.nuisances = 2 * origin.nuisances - down.state.nuisances;
    double reach = 1;
    for (std::size_t e = 0; e < down.state.effects.size(); ++e) {
      auto& [k, theta] = down.state.effects[e];
      const Effect& effect = model_.effects()[k];
      const double from = origin.effects[e].second, step = theta - from;
      if (step == 0) continue;
      theta = std::clamp(from - step, effect.minimum, effect.maximum), reach = (from - theta) / step;
    }
    if (reach > 0)
      failed.emplace_back(i, reach), mirrored.push_back(std::move(down));
    else
      fill_rows(responses[i], origin_of(i), origin_of(i), 1);
  }
  if (failed.empty()) return;
  const auto down = run(mirrored);
  for (std::size_t i = 0; i < failed.size(); ++i)
    fill_rows(responses[failed[i].first], origin_of(failed[i].first), down[i], failed[i].second);
}

void Fitter::add_shares(Linearization& at) {
  for (const auto& [k, theta] : at.state.effects) at.origin_theta.push_back(theta);
  const auto others = other_forms(at.state, model_.effects());
  std::vector<Responses::Request> requests;
  for (std::size_t s = 0; s < others.size(); ++s) {
    State moved = at.state;
    moved.shares.conservativeResizeLike(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(others.size())));
    moved.shares[static_cast<Eigen::Index>(s)] += nuisance_step;
    for (const int p : model_.training()) requests.push_back({moved, p});
  }
  const auto responses = model_.run(requests);
  const auto n = static_cast<std::ptrdiff_t>(model_.training().size());
  for (auto of_share = responses.begin(); of_share != responses.end(); of_share += n) at.by_share.emplace_back(of_share, of_share + n);
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

Eigen::MatrixXd Fitter::columns(const Linearization& at, const std::vector<std::vector<Response>>& moved,
                                const Whitening& whitening) const {
  const auto first = first_rows();
  const Eigen::VectorXd rho = residual(at.origin, whitening);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(first.back(), static_cast<Eigen::Index>(moved.size()));
  for (std::size_t j = 0; j < moved.size(); ++j) {
    for (std::size_t p = 0; p < at.origin.size(); ++p) {
      if (moved[j][p].value.size() == 0) continue;
      const int begin = first[p], n = first[p + 1] - begin;
      J.col(static_cast<Eigen::Index>(j)).segment(begin, n) =
          (snag::residual(model_.points()[model_.training()[p]], moved[j][p], whitening.factor[p]) - rho.segment(begin, n)) / nuisance_step;
    }
  }
  return J;
}

std::vector<Response> Fitter::run_near(const Linearization& at, const std::vector<Responses::Request>& requests) {
  std::vector<Responses::Request> leading = requests;
  for (Responses::Request& request : leading) request.state = lead_of(request.state);
  std::vector<Response> responses = model_.run(leading);
  const auto& training = model_.training();
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const State& state = requests[i].state;
    const auto p = static_cast<std::size_t>(std::find(training.begin(), training.end(), requests[i].point) - training.begin());
    const auto others = other_forms(state, model_.effects());
    for (Eigen::Index s = 0; s < state.shares.size(); ++s) {
      const std::size_t e = others[static_cast<std::size_t>(s)].effect;
      const double strength = at.origin_theta[e] != 0 ? state.effects[e].second / at.origin_theta[e] : 1;
      model_.add_share(responses[i], at.origin[p], at.by_share[static_cast<std::size_t>(s)][p], strength * state.shares[s] / nuisance_step,
                       requests[i].point);
    }
  }
  return responses;
}

std::vector<Response> Fitter::run_near(const Linearization& at, const State& state) {
  std::vector<Responses::Request> requests;
  for (const int p : model_.training()) requests.push_back({state, p});
  return run_near(at, requests);
}

Eigen::MatrixXd Fitter::effect_columns(const Hypothesis& hypothesis, const Linearization& at, const Whitening& whitening) {
  const State& state = at.state;
  const auto& training = model_.training();
  // Where runs are random their difference needs a step that stands out.
  const double size = model_.base_is_random() ? 0.5 : 0.1;
  std::vector<Responses::Request> requests;
  std::vector<double> steps;  // 0: nothing to derive by
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
    const Effect& effect = model_.effects()[hypothesis.effects[e]];
    if (effect.fixed) {
      steps.push_back(0);
      continue;
    }
    const double step = step_within_range(effect, state.effects[e].second, size * effect.sd);
    steps.push_back(step / effect.sd);
    if (step == 0) continue;
    State moved = state;
    moved.effects[e].second += step;
    for (const int p : training) requests.push_back({moved, p});
  }
  auto moved = run_near(at, requests);
  mirror_failed(state, at.responses, requests, moved, [&](const auto& down) { return run_near(at, down); });
  const Eigen::VectorXd rho = residual(at.responses, whitening);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rho.size(), static_cast<Eigen::Index>(steps.size()));
  auto next = moved.begin();
  for (std::size_t e = 0; e < steps.size(); ++e) {
    if (steps[e] == 0) continue;
    const std::vector<Response> own(next, next + static_cast<std::ptrdiff_t>(training.size()));
    next += static_cast<std::ptrdiff_t>(training.size());
    J.col(static_cast<Eigen::Index>(e)) = (residual(own, whitening) - rho) / steps[e];
  }
  return J;
}

// A state of which only the runs themselves are done; what else is needed is taken from the base model.
Linearization Fitter::start_from_base(const State& state) {
  Linearization at;
  at.state = state;
  at.responses = at.origin = model_.run(state, model_.training());
  at.numerical_error = base_.numerical_error;
  for (std::size_t e = 0; e < state.effects.size(); ++e) {
    State without = state;
    without.effects[e].second = 0;
    const auto responses = model_.run(without, model_.training());
    at.parts.emplace_back();
    for (std::size_t p = 0; p < responses.size(); ++p) at.parts[e].push_back(finite(at.responses[p].value - responses[p].value));
  }
  add_shares(at);
  return at;
}

}  // namespace snag
