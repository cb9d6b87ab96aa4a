#include "diagnosis/attribution/local_causes.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/attribution/screening.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr int n_places = 8;  // of a family in the scan
constexpr int n_beside = 4;  // places of a profile on each side of the gate

double spacing(const GateFamily& family) { return (family.high - family.low) / (n_places + 1); }

State state_with(const Responses& model, const State& base, int k, const Gate& gate) {
  State state = base;
  const Effect& effect = model.effects()[static_cast<std::size_t>(k)];
  state.effects = {{k, probe_strength(effect)}};
  state.gate = gate, state.gate->effect = effect.name;
  return state;
}

/// Evidence of one effect, linear in its strength.
class LinearScan {
 public:
  LinearScan(const Responses& model, const Fitter& fitter) : model_(model), fitter_(fitter), whitening_(fitter.whiten(fitter.base())) {
    linear_.rho = fitter.residual(fitter.base().responses, whitening_);
    const Eigen::MatrixXd inputs = fitter.nuisance_columns(fitter.base(), whitening_);
    linear_.J.resize(inputs.rows(), 1 + inputs.cols());
    linear_.J.rightCols(inputs.cols()) = inputs;
    linear_.prior = Eigen::VectorXd::Zero(linear_.J.cols());
  }

  /// Of its responses at the probe strength.
  LinearSolution evidence(int k, const std::vector<Response>& responses) {
    const Effect& effect = model_.effects()[static_cast<std::size_t>(k)];
    linear_.J.col(0) = (fitter_.residual(responses, whitening_) - linear_.rho) * (effect.sd / probe_strength(effect));
    linear_.prior[0] = effect.mean / effect.sd;
    linear_.lower = Eigen::VectorXd::Constant(1, effect.minimum / effect.sd);
    linear_.upper = Eigen::VectorXd::Constant(1, effect.maximum / effect.sd);
    return solve(linear_);
  }

 private:
  const Responses& model_;
  const Fitter& fitter_;
  Whitening whitening_;
  LinearModel linear_;
};

/// Evidence of a fit by the place of its gate.
struct Profile {
  std::vector<double> places, log_evidence;

  std::size_t best() const {
    return static_cast<std::size_t>(std::max_element(log_evidence.begin(), log_evidence.end()) - log_evidence.begin());
  }
  /// Of the parts of an integral over the place.
  std::vector<double> log_terms() const {
    std::vector<double> terms;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double before = places[i > 0 ? i - 1 : i], after = places[i + 1 < places.size() ? i + 1 : i];
      terms.push_back(log_evidence[i] + std::log(0.5 * (after - before)));
    }
    return terms;
  }
};

/// `effect`: the local one of the fit.
Profile profile_of(Responses& model, const Fitter& fitter, const Fit& fit, int effect, const GateFamily& family, double place,
                   double step) {
  Profile profile;
  std::vector<Responses::Request> requests;
  const Gate* own = model.gate_of(effect);
  for (int i = -n_beside; i <= n_beside; ++i) {
    const double other = place + i * step;
    if (other < family.low || other > family.high) continue;
    profile.places.push_back(other);
    State state = fit.at.state;
    state.gate = family.at(other), state.gate->effect = own->effect;
    for (const int p : model.training()) requests.push_back({state, p});
  }
  const std::vector<Response> responses = model.run(requests);
  const std::size_t n = model.training().size();
  for (std::size_t i = 0; i < profile.places.size(); ++i) {
    LinearModel linear = fit.linear;
    const auto begin = responses.begin() + static_cast<std::ptrdiff_t>(i * n);
    linear.rho = fitter.residual({begin, begin + static_cast<std::ptrdiff_t>(n)}, fit.whitening);
    profile.log_evidence.push_back(solve(linear).log_evidence);
  }
  return profile;
}

/// Log evidence of all places less that of the gate's own; `total`: log of the integral over the places.
double log_share_of(const Fit& fit, double total, const GateFamily& family) {
  return total - solve(fit.linear).log_evidence - std::log(family.high - family.low);
}

}  // namespace

int runs_of_scan(const Responses& model, const std::vector<int>& candidates, const std::vector<GateFamily>& families) {
  const auto n =
      std::count_if(candidates.begin(), candidates.end(), [&](int k) { return model.effects()[static_cast<std::size_t>(k)].may_be_local; });
  return static_cast<int>(n) * static_cast<int>(families.size()) * n_places;
}

LocalScan scan_local_causes(Responses& model, const Fitter& fitter, const std::vector<int>& candidates,
                            const std::vector<GateFamily>& families) {
  std::vector<Responses::Request> requests;
  std::vector<ScannedLocal> tried;
  const State base = fitter.base().state;
  for (const int k : candidates) {
    if (!model.effects()[static_cast<std::size_t>(k)].may_be_local) continue;
    tried.push_back({.effect = k, .family = {}});  // open everywhere
    for (const GateFamily& family : families)
      for (int i = 1; i <= n_places; ++i) tried.push_back({.effect = k, .family = family, .place = family.low + i * spacing(family)});
  }
  for (const ScannedLocal& one : tried) {
    State state = state_with(model, base, one.effect, one.family.at(one.place));
    if (one.family.is_everywhere()) state.gate.reset();
    for (const int p : model.training()) requests.push_back({state, p});
  }
  const std::vector<Response> responses = model.run(requests);
  const auto n = static_cast<std::ptrdiff_t>(model.training().size());
  LinearScan scan(model, fitter);
  LocalScan result{.best_everywhere = -std::numeric_limits<double>::infinity()};
  auto next = responses.begin();
  for (ScannedLocal& one : tried) {
    const LinearSolution solution = scan.evidence(one.effect, {next, next + n});
    next += n;
    const Effect& effect = model.effects()[static_cast<std::size_t>(one.effect)];
    one.log_evidence = solution.log_evidence, one.theta = effect.sd * solution.d[0];
    if (one.family.is_everywhere()) {
      result.best_everywhere = std::max(result.best_everywhere, one.log_evidence);
      continue;
    }
    const auto same = std::find_if(result.found.begin(), result.found.end(), [&](const ScannedLocal& other) {
      return other.effect == one.effect && other.family.axis == one.family.axis;
    });
    if (same == result.found.end())
      result.found.push_back(one);
    else if (one.log_evidence > same->log_evidence)
      *same = one;
  }
  std::stable_sort(result.found.begin(), result.found.end(),
                   [](const ScannedLocal& a, const ScannedLocal& b) { return a.log_evidence > b.log_evidence; });
  return result;
}

LocalFit fit_local_cause(Responses& model, Fitter& fitter, int effect, const ScannedLocal& scanned,
                         const std::function<bool(int runs_per_point)>& affordable) {
  const GateFamily& family = scanned.family;
  double place = scanned.place, step = 0.5 * spacing(family);
  Fit fit = fitter.fit({{effect}}, Eigen::VectorXd::Constant(1, scanned.theta));
  Profile profile = profile_of(model, fitter, fit, effect, family, place, step);
  // Nearer with each turn, until the places of a profile stand closer than what the evidence is known to.
  constexpr int turns = 3;
  for (int turn = 0; turn < turns && affordable(fitter.runs_of_fit(1)); ++turn) {
    const double moved = profile.places[profile.best()];
    const bool at_end = profile.best() == 0 || profile.best() + 1 == profile.places.size();
    if (moved != place) {
      place = moved;
      model.set_gate(effect, family.at(place));
      fit = fitter.fit({{effect}}, fit.theta, fit.at.state.forms);
    }
    if (!at_end) step *= 0.4;
    profile = profile_of(model, fitter, fit, effect, family, place, step);
  }
  const std::vector<double> terms = profile.log_terms();
  const double total = log_sum_exp(terms);
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) mean += std::exp(terms[i] - total) * profile.places[i];
  for (std::size_t i = 0; i < terms.size(); ++i) square += std::exp(terms[i] - total) * std::pow(profile.places[i] - mean, 2);
  const double log_share = log_share_of(fit, total, family);
  fit.log_evidence += log_share;
  LocalCause cause{.effect = model.gate_of(effect)->effect,
                   .coordinate = family.name(),
                   .unit = family.unit(),
                   .is_upwards = family.is_upwards,
                   .mean = mean,
                   .sd = std::max(std::sqrt(square), step / std::sqrt(12.0))};
  const double apart = std::max(step, cause.sd);
  return {std::move(fit), std::move(cause), {family, place, apart, log_share}};
}

int runs_of_places() { return 2 * n_beside + 1; }

double log_share_beside_others(Responses& model, const Fitter& fitter, const Fit& fit, int effect, const LocalPlace& alone) {
  const Profile profile = profile_of(model, fitter, fit, effect, alone.family, alone.place, alone.step);
  return log_share_of(fit, log_sum_exp(profile.log_terms()), alone.family);
}

}  // namespace snag
