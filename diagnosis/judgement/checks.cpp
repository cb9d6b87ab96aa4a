#include "diagnosis/judgement/checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

// Pairs of neighbouring rows of one path.
std::vector<std::pair<int, int>> neighbours(const Responses& model, const Fit& fit) {
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t p = 0; p < model.training().size(); ++p) {
    const auto& rows = model.points()[model.training()[p]].rows;
    for (int i = 1; i < static_cast<int>(rows.size()); ++i) {
      if (rows[i].kind == Row::Kind::path && rows[i - 1].kind == Row::Kind::path && rows[i].observable == rows[i - 1].observable)
        pairs.emplace_back(fit.first_row[p] + i - 1, fit.first_row[p] + i);
    }
  }
  return pairs;
}

double lag_one(const Eigen::VectorXd& rho, const std::vector<std::pair<int, int>>& pairs) {
  double sum = 0;
  for (const auto& [i, j] : pairs) sum += rho[i] * rho[j];
  return pairs.empty() ? 0 : sum / static_cast<double>(pairs.size());
}

// 2 E|z - Y| - E|z - z'| - E|Y - Y'| of values z against a standard normal Y.
double energy_to_normal(std::vector<double> z) {
  std::sort(z.begin(), z.end());
  const double n = static_cast<double>(z.size()), root_pi = std::sqrt(std::numbers::pi);
  double to_normal = 0, within = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double phi = std::exp(-0.5 * z[i] * z[i]) / std::sqrt(2 * std::numbers::pi);
    to_normal += z[i] * (2 * normal_cdf(z[i]) - 1) + 2 * phi;
    within += z[i] * (2 * static_cast<double>(i) - n + 1);
  }
  return 2 * to_normal / n - 2 * within / (n * n) - 2 / root_pi;
}

std::vector<double> values(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

}  // namespace

std::vector<PredictiveCheck> predictive_checks(const Responses& model, const Fit& fit, std::uint64_t seed) {
  const Eigen::VectorXd& rho = fit.residual;
  const double n = static_cast<double>(rho.size());
  if (n == 0) return {};
  // The least of |rho + J d|^2 + |d - prior|^2 is chi2 with as many degrees of freedom as rows.
  const Eigen::VectorXd deviation = fit.solution.d - fit.linear.prior;
  const double chi2 = rho.squaredNorm() + deviation.squaredNorm();
  std::vector<PredictiveCheck> checks{{"chi2", chi2, chi_squared_tail(chi2, n)}};
  const auto pairs = neighbours(model, fit);
  const double largest = rho.cwiseAbs().maxCoeff(), lag = lag_one(rho, pairs), energy = energy_to_normal(values(rho));
  // Residuals of data that the fitted model would make: what the fit takes out of noise is taken out of them too.
  const Eigen::MatrixXd &J = fit.linear.J, gain = fit.solution.covariance * J.transpose();
  NormalNumbers random(seed);
  constexpr int draws = 400;
  double lag_mean = 0, lag_square = 0, log_energy_mean = 0, log_energy_square = 0;
  for (int k = 0; k < draws; ++k) {
    Eigen::VectorXd e(rho.size()), prior(J.cols());
    for (double& v : e) v = random();
    for (double& v : prior) v = random();
    // y - f0 = J prior + e: the residual of its fit.
    const Eigen::VectorXd y = J * prior + e, r = y - J * (gain * y);
    const double l = lag_one(r, pairs), s = std::log(std::max(energy_to_normal(values(r)), 1e-12));
    lag_mean += l / draws, lag_square += l * l / draws, log_energy_mean += s / draws, log_energy_square += s * s / draws;
  }
  const auto score = [](double value, double mean, double square) {
    return (value - mean) / std::sqrt(std::max(square - mean * mean, 1e-12));
  };
  if (!pairs.empty()) checks.push_back({"lag1_autocorrelation", lag, two_sided_p(score(lag, lag_mean, lag_square))});
  checks.push_back({"max_abs_z", largest, -std::expm1(n * std::log1p(-std::min(two_sided_p(largest), 1 - 1e-15)))});
  // Residuals smaller than the uncertainties let expect are no gap: somebody was too careful.
  const double unlike = normal_cdf(-score(std::log(std::max(energy, 1e-12)), log_energy_mean, log_energy_square));
  checks.push_back({"energy_distance", energy, chi2 < n ? 1 : unlike});
  return checks;
}

std::vector<EffectEstimate> estimates(const Responses& model, const Fit& fit) {
  std::vector<EffectEstimate> all;
  const int bounded = static_cast<int>(fit.linear.lower.size());
  for (int e = 0; e < static_cast<int>(fit.hypothesis.effects.size()); ++e) {
    const Effect& effect = model.effects()[fit.hypothesis.effects[e]];
    EffectEstimate estimate{.mean = fit.theta[e], .sd = fit.theta_sd[e], .unit = effect.unit};
    constexpr double far = 3;
    estimate.absorbing = std::abs(estimate.mean - effect.mean) > far * effect.sd;
    double weight = 0, sum = 0, square = 0;
    int n = 0;
    for (std::size_t p = 0; e < bounded && p + 1 < fit.first_row.size(); ++p) {
      // The other effect stays where the fit put it; nuisances keep their priors; the strength itself has none.
      const auto J = fit.linear.J.middleRows(fit.first_row[p], fit.first_row[p + 1] - fit.first_row[p]);
      const auto rho = fit.linear.rho.segment(fit.first_row[p], fit.first_row[p + 1] - fit.first_row[p]);
      Eigen::MatrixXd H = J.transpose() * J + Eigen::MatrixXd::Identity(J.cols(), J.cols());
      Eigen::VectorXd g = J.transpose() * rho - fit.linear.prior;
      H(e, e) -= 1, g[e] += fit.linear.prior[e];
      constexpr double tight = 1e12, least_information = 1e-6;
      for (int other = 0; other < bounded; ++other)
        if (other != e) H(other, other) += tight, g[other] = -tight * fit.solution.d[other];
      if (H(e, e) < least_information) continue;
      const Eigen::LDLT<Eigen::MatrixXd> factor(H);
      const double d = -factor.solve(g)[e], variance = factor.solve(Eigen::VectorXd::Unit(H.rows(), e))[e];
      if (!(variance > 0) || variance > 1 / least_information) continue;
      estimate.per_point[model.experiment().points[model.training()[p]].id] = fit.theta[e] + effect.sd * (d - fit.solution.d[e]);
      weight += 1 / variance, sum += d / variance, square += d * d / variance, ++n;
    }
    if (n > 1) estimate.cochran_p = chi_squared_tail(std::max(0.0, square - sum * sum / weight), n - 1);
    all.push_back(estimate);
  }
  return all;
}

}  // namespace snag
