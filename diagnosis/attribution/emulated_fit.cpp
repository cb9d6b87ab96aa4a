#include "diagnosis/attribution/emulated_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/attribution/screening.hpp"
#include "diagnosis/fitting/emulator.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

class EmulatedFit {
 public:
  EmulatedFit(Responses& model, Fitter& fitter, int index, const std::vector<double>& strengths, const Refinement& refinement)
      : model_(model),
        fitter_(fitter),
        index_(index),
        effect_(model.effects()[index]),
        strengths_(with_base(strengths, refinement)),
        emulator_(strengths_, runs(refinement)) {}

  Fit fit() const {
    constexpr int n = 61;
    const double step = (strengths_.back() - strengths_.front()) / (n - 1);
    std::vector<double> log_terms;
    std::size_t best = 0;
    const double mass =
        normal_cdf((effect_.maximum - effect_.mean) / effect_.sd) - normal_cdf((effect_.minimum - effect_.mean) / effect_.sd);
    const auto strength = [&](std::size_t i) { return strengths_.front() + step * static_cast<double>(i); };
    for (std::size_t i = 0; i < n; ++i) {
      const double t = (strength(i) - effect_.mean) / effect_.sd, width = i == 0 || i == n - 1 ? 0.5 * step : step;
      log_terms.push_back(log_evidence(strength(i)) + std::log(width / effect_.sd) - 0.5 * t * t - 0.5 * std::log(2 * std::numbers::pi) -
                          std::log(mass));
      if (log_terms[i] > log_terms[best]) best = i;
    }
    const double total = log_sum_exp(log_terms);
    double mean = 0, square = 0;
    for (std::size_t i = 0; i < n; ++i) mean += std::exp(log_terms[i] - total) * strength(i);
    for (std::size_t i = 0; i < n; ++i) square += std::exp(log_terms[i] - total) * std::pow(strength(i) - mean, 2);
    Fit fit = at(strength(best), likeliest_form_error(strength(best)));
    fit.at.origin = fitter_.base().responses, fit.at.by_nuisance = fitter_.base().by_nuisance;
    add_strength(fit, strength(best), step);
    fit.log_evidence = total;
    fit.theta = Eigen::VectorXd::Constant(1, mean);
    fit.theta_sd = Eigen::VectorXd::Constant(1, std::max(std::sqrt(square), step / std::sqrt(12.0)));
    return fit;
  }

 private:
  static std::vector<double> with_base(std::vector<double> strengths, const Refinement& refinement) {
    strengths.push_back(0);
    if (refinement.n_seeds > 0 && std::count(strengths.begin(), strengths.end(), refinement.strength) == 0)
      strengths.push_back(refinement.strength);
    std::sort(strengths.begin(), strengths.end());
    return strengths;
  }

  State state(double strength) const {
    State state = fitter_.base().state;
    if (strength != 0) state.effects = {{index_, strength}};
    return state;
  }

  std::vector<std::vector<Response>> runs(const Refinement& refinement) {
    std::vector<Responses::Request> requests;
    for (const double strength : strengths_)
      for (const int p : model_.training())
        requests.push_back({state(strength), p, 1, strength == refinement.strength ? refinement.n_seeds : 0});
    const auto responses = model_.run(requests);
    const auto n = static_cast<std::ptrdiff_t>(model_.training().size());
    std::vector<std::vector<Response>> by_strength;
    for (auto one = responses.begin(); one != responses.end(); one += n) by_strength.emplace_back(one, one + n);
    return by_strength;
  }

  /// Errors of form are known of effects that are not random; the mean of random runs is no mixture of forms.
  std::vector<double> errors_of_form() const {
    return effect_.random ? std::vector<double>{0.0} : std::vector<double>(form_errors.begin(), form_errors.end());
  }

  Fit at(double strength, double form_error) const {
    const Linearization& base = fitter_.base();
    Fit fit;
    fit.hypothesis = {{index_}}, fit.first_row = fitter_.first_rows(), fit.form_error = form_error;
    fit.at.state = base.state;
    fit.at.state.effects = {{index_, strength}};
    fit.at.responses = emulator_.at(strength);
    fit.at.numerical_error = base.numerical_error;
    if (!effect_.random) {
      fit.at.parts.emplace_back();
      for (std::size_t p = 0; p < fit.at.responses.size(); ++p)
        fit.at.parts.back().push_back(finite(fit.at.responses[p].value - base.responses[p].value));
    }
    fit.whitening = fitter_.whiten(fit.at, form_error);
    fit.linear.rho = fitter_.residual(fit.at.responses, fit.whitening);
    fit.linear.J = fitter_.nuisance_columns(base, fit.whitening);
    fit.linear.prior = Eigen::VectorXd::Zero(fit.linear.J.cols());
    fit.linear.lower.resize(0), fit.linear.upper.resize(0);
    fit.solution = solve(fit.linear);
    fit.log_evidence = fit.solution.log_evidence - 0.5 * fit.whitening.log_determinant;
    return fit;
  }

  double log_evidence(double strength) const {
    std::vector<double> terms;
    for (const double form_error : errors_of_form()) terms.push_back(at(strength, form_error).log_evidence);
    return log_sum_exp(terms) - std::log(static_cast<double>(terms.size()));
  }

  double likeliest_form_error(double strength) const {
    const auto all = errors_of_form();
    return *std::max_element(all.begin(), all.end(),
                             [&](double a, double b) { return at(strength, a).log_evidence < at(strength, b).log_evidence; });
  }

  /// The strength becomes the first parameter of the fit's linear model.
  void add_strength(Fit& fit, double strength, double step) const {
    const double to = std::min(strength + step, strengths_.back()), from = std::max(strength - step, strengths_.front());
    const Eigen::VectorXd column =
        (fitter_.residual(emulator_.at(to), fit.whitening) - fitter_.residual(emulator_.at(from), fit.whitening)) *
        (effect_.sd / (to - from));
    LinearModel& linear = fit.linear;
    const Eigen::MatrixXd nuisances = linear.J;
    linear.J.resize(nuisances.rows(), nuisances.cols() + 1);
    linear.J << column, nuisances;
    linear.prior = Eigen::VectorXd::Zero(linear.J.cols());
    linear.prior[0] = (effect_.mean - strength) / effect_.sd;
    linear.lower = Eigen::VectorXd::Constant(1, (effect_.minimum - strength) / effect_.sd);
    linear.upper = Eigen::VectorXd::Constant(1, (effect_.maximum - strength) / effect_.sd);
    fit.solution = solve(linear);
    fit.residual = linear.rho + linear.J * fit.solution.d;
  }

  Responses& model_;
  Fitter& fitter_;
  int index_;
  const Effect& effect_;
  std::vector<double> strengths_;
  Emulator emulator_;
};

std::vector<double> shares_of_probe(const Effect& effect, const std::vector<double>& shares) {
  std::vector<double> strengths;
  for (const double share : shares) {
    const double strength = std::clamp(share * probe_strength(effect), effect.minimum, effect.maximum);
    if (strength != 0 && std::count(strengths.begin(), strengths.end(), strength) == 0) strengths.push_back(strength);
  }
  return strengths;
}

}  // namespace

std::vector<double> emulated_strengths(const Effect& effect) {
  if (effect.minimum < 0 && effect.maximum > 0) return shares_of_probe(effect, {-2.2, -1.1, -0.4, 0.4, 1.1, 2.2});
  // As far as the prior goes: where no run is, the integral over the strength has nothing.
  constexpr double far = 2.5;  // standard deviations
  const double probe = probe_strength(effect), end = (effect.mean + std::copysign(far * effect.sd, probe)) / probe;
  return shares_of_probe(effect, {0.1, 0.3, 0.6, 1.0, 1.5, std::max(2.2, end)});
}

std::vector<double> first_strengths(const Effect& effect) {
  const bool both_signs = effect.minimum < 0 && effect.maximum > 0;
  return shares_of_probe(effect, both_signs ? std::vector<double>{-1.1, 1.1} : std::vector<double>{0.3, 1.0});
}

Fit fit_by_emulator(Responses& model, Fitter& fitter, int effect, const std::vector<double>& strengths, const Refinement& refinement) {
  return EmulatedFit(model, fitter, effect, strengths, refinement).fit();
}

}  // namespace snag
