#include "diagnosis/attribution/remainder.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "diagnosis/attribution/discrepancy_shape.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr std::array amplitudes{0.01, 0.03, 0.1, 0.3};
/// Effects are the cause of a gap where they explain the larger part of its square; of the rest the process is the remainder. In the metric
/// P of the shares (remainder.hpp) the gap is then within 45 degrees of what they add; beyond, it is more unlike them than like them. The
/// choice is not critical: of 26 sets of development (spheres of tests/other_programs, with pairs, local causes and forces of no library)
/// no verdict and no probability differs between 0.3, 0.5, 0.7 and no limit. In 135 of their 268 fits with effects the process takes more
/// than half, but either another fit leads, or "outside" does with and without the credit.
constexpr double largest_share = 0.5;

class RemainderFit {
 public:
  RemainderFit(const Responses& model, const Fit& none, const Fit& fit) : model_(model), fit_(fit), linear_(fit.linear) {
    for (std::size_t p = 0; p < model.training().size(); ++p) scales_.push_back(scale(none, p));
  }

  Remainder fit() {
    Remainder result;
    std::vector<double> gains;
    double best = -std::numeric_limits<double>::infinity();
    DiscrepancyShape best_shape = discrepancy_shapes.front();
    double best_amplitude = 0;
    const double without = solve(linear_).log_evidence;
    for (const DiscrepancyShape& shape : discrepancy_shapes) {
      const std::vector<Eigen::MatrixXd> process = whitened_process(shape);
      for (const double amplitude : amplitudes) {
        gains.push_back(evidence(amplitude, process) - without);
        if (gains.back() > best) best = gains.back(), best_shape = shape, best_amplitude = amplitude;
      }
    }
    result.log_evidence = log_sum_exp(gains) - std::log(static_cast<double>(gains.size()));
    find_shares(result, best_amplitude, best_shape);
    const bool is_small = !(result.share > largest_share);
    result.gain = (is_small ? log_sum_exp(std::array{0.0, result.log_evidence}) : 0) - std::numbers::ln2;
    return result;
  }

 private:
  const PointSummary& point(std::size_t p) const { return model_.points()[static_cast<std::size_t>(model_.training()[p])]; }

  // Root mean square of what no effect leaves, the same for all rows of one unit; by Gaussian row.
  Eigen::VectorXd scale(const Fit& none, std::size_t p) const {
    const int g = point(p).n_gaussian;
    const Eigen::VectorXd all = none.whitening.factor[p].matrixL() * none.residual.segment(none.first_row[p], g);
    std::map<int, std::pair<double, int>> square;  // by observable
    const auto& observables = model_.experiment().observables;
    for (int i = 0; i < g; ++i) square[point(p).rows[i].observable].first += all[i] * all[i], ++square[point(p).rows[i].observable].second;
    std::map<std::string, double> largest;  // by unit
    for (const auto& [o, sum] : square)
      largest[observables[o].unit] = std::max(largest[observables[o].unit], std::sqrt(sum.first / sum.second));
    Eigen::VectorXd scales(g);
    for (int i = 0; i < g; ++i) scales[i] = largest[observables[point(p).rows[i].observable].unit];
    return scales;
  }

  // At an amplitude of one, by training point. Whitened with C, the process is L^-1 K L^-T beside unit noise.
  std::vector<Eigen::MatrixXd> whitened_process(const DiscrepancyShape& shape) const {
    std::vector<Eigen::MatrixXd> all;
    for (std::size_t p = 0; p < scales_.size(); ++p) {
      const auto L = fit_.whitening.factor[p].matrixL();
      const Eigen::MatrixXd K = discrepancy_correlation(point(p), shape).cwiseProduct(scales_[p] * scales_[p].transpose());
      const Eigen::MatrixXd half = L.solve(K);
      all.push_back(L.solve(half.transpose()));
    }
    return all;
  }

  // Of the linear model at the fit, without the terms of C that are common to all processes.
  double evidence(double amplitude, const std::vector<Eigen::MatrixXd>& process) {
    LinearModel whitened = linear_;
    double log_determinant = 0;
    for (std::size_t p = 0; p < scales_.size(); ++p) {
      const int g = point(p).n_gaussian, begin = fit_.first_row[p];
      if (g == 0) continue;
      const Eigen::LLT<Eigen::MatrixXd> factor(amplitude * amplitude * process[p] + Eigen::MatrixXd::Identity(g, g));
      whitened.rho.segment(begin, g) = factor.matrixL().solve(linear_.rho.segment(begin, g));
      whitened.J.middleRows(begin, g) = factor.matrixL().solve(linear_.J.middleRows(begin, g));
      const Eigen::MatrixXd& L = factor.matrixLLT();
      log_determinant += 2 * L.diagonal().array().log().sum();
    }
    solution_ = solve(whitened);
    return solution_.log_evidence - 0.5 * log_determinant;
  }

  void find_shares(Remainder& result, double amplitude, const DiscrepancyShape& shape) {
    const bool has_process = result.log_evidence > 0;
    const std::vector<Eigen::MatrixXd> process = whitened_process(shape);
    if (has_process) evidence(amplitude, process);  // its solution
    const Eigen::VectorXd residual = linear_.rho + linear_.J * (has_process ? solution_.d : fit_.solution.d);
    const std::size_t n = fit_.at.parts.size();
    std::vector<Eigen::VectorXd> parts(n + 1, Eigen::VectorXd::Zero(linear_.rho.size()));  // the process last
    for (std::size_t p = 0; p < scales_.size(); ++p) {
      const int g = point(p).n_gaussian, begin = fit_.first_row[p];
      const auto L = fit_.whitening.factor[p].matrixL();
      for (std::size_t e = 0; e < n && g > 0; ++e) parts[e].segment(begin, g) = L.solve(fit_.at.parts[e][p].head(g));
      if (!has_process || g == 0) continue;
      const Eigen::MatrixXd K = amplitude * amplitude * process[p];
      parts[n].segment(begin, g) = K * (K + Eigen::MatrixXd::Identity(g, g)).llt().solve(residual.segment(begin, g));
    }
    Eigen::VectorXd gap = Eigen::VectorXd::Zero(linear_.rho.size());
    for (const Eigen::VectorXd& part : parts) gap += part;
    const auto J = linear_.J.middleCols(linear_.lower.size(), static_cast<Eigen::Index>(model_.nuisances().size()));
    const Eigen::MatrixXd precision = J.transpose() * J + Eigen::MatrixXd::Identity(J.cols(), J.cols());
    const Eigen::VectorXd projected = gap - J * precision.llt().solve(J.transpose() * gap);
    const double square = gap.dot(projected);
    const auto share = [&](const Eigen::VectorXd& part) {
      return square > 0 ? part.dot(projected) / square : std::numeric_limits<double>::quiet_NaN();
    };
    for (std::size_t e = 0; e < n; ++e) result.share_of_effect.push_back(share(parts[e]));
    result.share = share(parts[n]);
  }

  const Responses& model_;
  const Fit& fit_;
  const LinearModel& linear_;
  std::vector<Eigen::VectorXd> scales_;  // by training point
  LinearSolution solution_;              // of the process that was tried last
};

}  // namespace

Remainder fit_remainder(const Responses& model, const Fit& none, const Fit& fit) {
  if (fit.hypothesis.effects.empty() || fit.at.parts.size() != fit.hypothesis.effects.size()) return {};
  return RemainderFit(model, none, fit).fit();
}

}  // namespace snag
