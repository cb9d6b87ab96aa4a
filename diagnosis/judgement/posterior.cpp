#include "diagnosis/judgement/posterior.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/statistics/linear_model.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

/// Draws of d, one a column, with the logarithms of their weights.
struct Sample {
  Eigen::MatrixXd d;
  std::vector<double> log_weight;
};

Sample within_bounds(const LinearModel& linear, const Eigen::MatrixXd& covariance, int n, NormalNumbers& random) {
  const Eigen::Index size = covariance.rows(), k = linear.lower.size();
  const Eigen::VectorXd centre = -covariance * (linear.J.transpose() * linear.rho - linear.prior);
  const Eigen::MatrixXd L = covariance.llt().matrixL();
  Sample sample{Eigen::MatrixXd(size, n), std::vector<double>(static_cast<std::size_t>(n), 0)};
  Eigen::VectorXd z(size);
  for (int draw = 0; draw < n; ++draw) {
    for (Eigen::Index i = 0; i < size; ++i) {
      if (i >= k) {
        z[i] = random();
        continue;
      }
      const double before = centre[i] + L.row(i).head(i).dot(z.head(i));
      const TruncatedDraw drawn =
          truncated_normal_draw((linear.lower[i] - before) / L(i, i), (linear.upper[i] - before) / L(i, i), random.uniform());
      z[i] = drawn.value, sample.log_weight[static_cast<std::size_t>(draw)] += drawn.log_mass;
    }
    sample.d.col(draw) = centre + L * z;
  }
  return sample;
}

/// Which draws stay when as many are taken by weight, at even steps of the summed weights: all of them where the weights are equal.
std::vector<int> resampled(const std::vector<double>& log_weight, double start) {
  const double log_total = log_sum_exp(log_weight);
  const auto n = static_cast<double>(log_weight.size());
  std::vector<int> chosen;
  double sum = 0;
  for (std::size_t i = 0; i < log_weight.size(); ++i) {
    sum += std::exp(log_weight[i] - log_total) * n;
    while (static_cast<double>(chosen.size()) + start < sum && chosen.size() < log_weight.size()) chosen.push_back(static_cast<int>(i));
  }
  while (chosen.size() < log_weight.size()) chosen.push_back(static_cast<int>(log_weight.size()) - 1);  // rounding of the sum
  return chosen;
}

}  // namespace

Eigen::MatrixXd posterior_of(const LinearModel& linear, int n, std::uint64_t seed) {
  NormalNumbers random(seed + 104729);  // other numbers than those of the runs
  const Eigen::Index size = linear.J.cols();
  const Eigen::MatrixXd precision = linear.J.transpose() * linear.J + Eigen::MatrixXd::Identity(size, size);
  const Sample sample = within_bounds(linear, precision.llt().solve(Eigen::MatrixXd::Identity(size, size)), n, random);
  std::vector<int> chosen = resampled(sample.log_weight, 0.5);
  // Equal draws lie side by side, and chains are stretches of the list: it is mixed.
  for (std::size_t i = chosen.size() - 1; i > 0; --i)
    std::swap(chosen[i], chosen[static_cast<std::size_t>(random.index(static_cast<int>(i) + 1))]);
  return sample.d(Eigen::all, chosen);
}

PosteriorDraws posterior_draws(const Responses& model, const Fit& fit, const std::string& name, std::uint64_t seed) {
  const Eigen::MatrixXd d = posterior_of(fit.linear, n_posterior_draws, seed);
  PosteriorDraws posterior{.hypothesis = name};
  const auto k = fit.linear.lower.size();
  for (Eigen::Index e = 0; e < k; ++e) {
    const Effect& effect = model.effects()[static_cast<std::size_t>(fit.hypothesis.effects[static_cast<std::size_t>(e)])];
    if (effect.fixed) continue;
    PosteriorDraws::Variable variable{.name = effect.name, .unit = effect.unit};
    const double scale = fit.theta_sd[e] / std::sqrt(fit.solution.covariance(e, e));
    for (Eigen::Index i = 0; i < d.cols(); ++i)
      variable.draws.push_back(std::clamp(fit.theta[e] + scale * (d(e, i) - fit.solution.d[e]), effect.minimum, effect.maximum));
    posterior.variables.push_back(std::move(variable));
  }
  for (std::size_t j = 0; j < model.nuisances().size(); ++j) {
    const Eigen::Index row = k + static_cast<Eigen::Index>(j);
    PosteriorDraws::Variable variable{.name = model.name_of_nuisance(static_cast<int>(j)), .unit = "u", .is_strength = false};
    for (Eigen::Index i = 0; i < d.cols(); ++i) variable.draws.push_back(d(row, i) - fit.linear.prior[row]);
    posterior.variables.push_back(std::move(variable));
  }
  return posterior;
}

}  // namespace snag
