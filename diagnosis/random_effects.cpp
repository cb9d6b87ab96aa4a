#include "diagnosis/random_effects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "diagnosis/screening.hpp"
#include "diagnosis/statistics.hpp"

namespace snag {

namespace {

// A state of the base model with one strength, judged with the nuisances linear.
Fit fit_at(Responses& model, Fitter& fitter, int effect, double theta) {
  const Linearization& base = fitter.base();
  Fit fit;
  fit.hypothesis = {{effect}}, fit.first_row = fitter.first_rows();
  fit.at.state = base.state;
  fit.at.state.effects = {{effect, theta}};
  fit.at.responses = model.run(fit.at.state, model.training());
  fit.at.numerical_error = base.numerical_error;
  fit.whitening = fitter.whiten(fit.at);
  fit.linear.rho = fitter.residual(fit.at.responses, fit.whitening);
  fit.linear.J = fitter.nuisance_columns(base, fit.whitening);
  fit.linear.prior = Eigen::VectorXd::Zero(fit.linear.J.cols());
  fit.linear.lower.resize(0), fit.linear.upper.resize(0);
  fit.solution = solve(fit.linear);
  fit.log_evidence = fit.solution.log_evidence - 0.5 * fit.whitening.log_determinant;
  fit.residual = fit.linear.rho + fit.linear.J * fit.solution.d;
  return fit;
}

}  // namespace

Fit fit_random_effect(Responses& model, Fitter& fitter, int index) {
  const Effect& effect = model.effects()[index];
  constexpr std::array shares{0.1, 0.3, 0.6, 1.0, 1.5, 2.2};
  std::vector<Fit> fits;
  std::vector<double> strengths, log_terms;
  for (const double share : shares) {
    const double theta = std::clamp(share * probe_strength(effect), effect.minimum, effect.maximum);
    if (strengths.empty() || theta > strengths.back()) strengths.push_back(theta);
  }
  for (const double theta : strengths) fits.push_back(fit_at(model, fitter, index, theta));
  // Trapezoids under prior times evidence; the prior is what the range leaves of a normal one.
  const double mass = normal_cdf((effect.maximum - effect.mean) / effect.sd) - normal_cdf((effect.minimum - effect.mean) / effect.sd);
  const std::size_t n = strengths.size();
  std::size_t best = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double left = i > 0 ? strengths[i - 1] : effect.minimum, right = i + 1 < n ? strengths[i + 1] : strengths[i];
    const double width = std::max(n == 1 ? effect.sd : 0.5 * (right - left), 1e-300), t = (strengths[i] - effect.mean) / effect.sd;
    log_terms.push_back(fits[i].log_evidence + std::log(width / effect.sd) - 0.5 * t * t - 0.5 * std::log(2 * std::numbers::pi) -
                        std::log(mass));
    if (log_terms[i] > log_terms[best]) best = i;
  }
  const double total = log_sum_exp(log_terms);
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < n; ++i) mean += std::exp(log_terms[i] - total) * strengths[i];
  for (std::size_t i = 0; i < n; ++i) square += std::exp(log_terms[i] - total) * std::pow(strengths[i] - mean, 2);
  Fit fit = std::move(fits[best]);
  fit.log_evidence = total;
  fit.theta = Eigen::VectorXd::Constant(1, mean);
  const double resolution =
      n > 1 ? 0.5 * (strengths[std::min(best + 1, n - 1)] - strengths[best > 0 ? best - 1 : 0]) / std::sqrt(12.0) : effect.sd;
  fit.theta_sd = Eigen::VectorXd::Constant(1, std::max(std::sqrt(square), resolution));
  return fit;
}

}  // namespace snag
