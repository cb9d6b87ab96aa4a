#include "diagnosis/outside.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace snag {

namespace {

constexpr std::array amplitudes{0.0, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0};
constexpr std::array lengths{0.1, 0.3, 1.0};

class GaussianProcess {
 public:
  GaussianProcess(const Responses& model, const Fitter& fitter) : model_(model) {
    const Linearization& base = fitter.base();
    const auto& training = model.training();
    n_observables_ = static_cast<int>(model.experiment().observables.size());
    for (std::size_t p = 0; p < training.size(); ++p) {
      const PointSummary& point = model.points()[training[p]];
      const int g = point.n_gaussian, n = static_cast<int>(point.rows.size());
      Block block{
          &point, Eigen::MatrixXd::Identity(n, n), {}, Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(base.by_nuisance.size())), {}};
      block.covariance.topLeftCorner(g, g) = model_covariance(point, base.responses[p], base.numerical_error[p], {});
      // Gaussian rows in their own units, the others as deviance residuals of unit variance.
      const Eigen::LLT<Eigen::MatrixXd> none(Eigen::MatrixXd::Identity(g, g));
      block.difference = residual(point, base.responses[p], none);
      for (std::size_t j = 0; j < base.by_nuisance.size(); ++j) {
        if (base.by_nuisance[j][p].value.size() > 0)
          block.nuisances.col(static_cast<Eigen::Index>(j)) =
              (residual(point, base.by_nuisance[j][p], none) - block.difference) / nuisance_step;
      }
      block.range = ranges(point, base.responses[p]);
      n_gaussian_ += g;
      log_ratio_ += log_variance_ratio(point, base.responses[p]);
      blocks_.push_back(std::move(block));
    }
  }

  int n_observables() const { return n_observables_; }

  double log_marginal(const std::vector<double>& amplitude, double length, bool growing) const {
    const Eigen::Index m = blocks_.front().nuisances.cols();
    Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(m, m);
    Eigen::VectorXd projected = Eigen::VectorXd::Zero(m);
    double value = -0.5 * n_gaussian_ * std::log(2 * std::numbers::pi) - 0.5 * log_ratio_;
    for (const Block& block : blocks_) {
      const Eigen::LLT<Eigen::MatrixXd> factor(covariance(block, amplitude, length, growing));
      const Eigen::VectorXd r = factor.matrixL().solve(block.difference);
      const Eigen::MatrixXd J = factor.matrixL().solve(block.nuisances);
      const Eigen::MatrixXd& L = factor.matrixLLT();
      value -= 0.5 * r.squaredNorm() + L.diagonal().array().log().sum();
      precision += J.transpose() * J, projected += J.transpose() * r;
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(precision);
    const Eigen::MatrixXd& L = factor.matrixLLT();
    return value + 0.5 * projected.dot(factor.solve(projected)) - L.diagonal().array().log().sum();
  }

 private:
  struct Block {
    const PointSummary* point;
    Eigen::MatrixXd covariance;
    Eigen::VectorXd difference;
    Eigen::MatrixXd nuisances;
    std::vector<double> range;  // by row
  };

  // How far quantities of one unit move in the base model, the same for all of them; a pure number or an angle: 1.
  std::vector<double> ranges(const PointSummary& point, const Response& response) const {
    const auto& observables = model_.experiment().observables;
    std::vector<double> own(observables.size(), 0), low(observables.size(), std::numeric_limits<double>::max()),
        high(observables.size(), -std::numeric_limits<double>::max());
    for (int i = 0; i < point.n_gaussian; ++i) {
      const int o = point.rows[i].observable;
      low[o] = std::min(low[o], response.value[i]), high[o] = std::max(high[o], response.value[i]);
      own[o] = point.rows[i].kind == Row::Kind::scalar ? std::abs(response.value[i]) : high[o] - low[o];
    }
    std::vector<double> range;
    for (int i = 0; i < static_cast<int>(point.rows.size()); ++i) {
      const Observable& observable = observables[point.rows[i].observable];
      double largest = 0;
      for (std::size_t o = 0; o < own.size(); ++o)
        if (observables[o].unit == observable.unit) largest = std::max(largest, own[o]);
      const bool pure = observable.kind == Observable::Kind::angle || observable.kind == Observable::Kind::lognormal || largest <= 0;
      range.push_back(pure ? 1 : largest);
    }
    return range;
  }

  static Eigen::MatrixXd covariance(const Block& block, const std::vector<double>& amplitude, double length, bool growing) {
    Eigen::MatrixXd K = block.covariance;
    const auto& rows = block.point->rows;
    const double duration = std::max(block.point->duration, 1e-300);
    const auto time = [&](const Row& row) { return row.kind == Row::Kind::path ? 0.5 * (row.begin + row.end) / duration : 1; };
    for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
      if (amplitude[rows[i].observable] == 0) continue;
      constexpr double deviance_scale = 3;
      if (!is_gaussian(rows[i])) K(i, i) += deviance_scale * deviance_scale;
      if (!is_gaussian(rows[i])) continue;
      for (int j = 0; j < block.point->n_gaussian; ++j) {
        if (rows[j].observable != rows[i].observable) continue;
        const double s = amplitude[rows[i].observable], a = time(rows[i]), b = time(rows[j]), apart = (a - b) / length;
        K(i, j) += s * block.range[i] * s * block.range[j] * (growing ? a * b : 1) * std::exp(-0.5 * apart * apart);
      }
    }
    return K;
  }

  const Responses& model_;
  std::vector<Block> blocks_;
  int n_observables_ = 0, n_gaussian_ = 0;
  double log_ratio_ = 0;  // of the rows that are not Gaussian
};

}  // namespace

Outside fit_outside(const Responses& model, const Fitter& fitter) {
  const GaussianProcess process(model, fitter);
  Outside best;
  best.log_evidence = -std::numeric_limits<double>::infinity();
  const auto try_one = [&](const std::vector<double>& amplitude, double length, bool growing) {
    const double value = process.log_marginal(amplitude, length, growing);
    if (value > best.log_evidence) best = {value, length, growing, amplitude};
  };
  for (const double length : lengths)
    for (const bool growing : {false, true})
      for (std::size_t a = 1; a < amplitudes.size(); ++a)
        try_one(std::vector<double>(process.n_observables(), amplitudes[a]), length, growing);
  // Then each observable may choose its own amplitude; at least one keeps one, or it would be the base model.
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (int o = 0; o < process.n_observables(); ++o) {
      for (const double a : amplitudes) {
        std::vector<double> amplitude = best.amplitude;
        amplitude[o] = a;
        if (std::any_of(amplitude.begin(), amplitude.end(), [](double s) { return s > 0; })) try_one(amplitude, best.length, best.growing);
      }
    }
    for (const double length : lengths)
      for (const bool growing : {false, true}) try_one(best.amplitude, length, growing);
  }
  // The share of the prior that one choice of the grid has.
  best.log_evidence -= process.n_observables() * std::log(static_cast<double>(amplitudes.size())) + std::log(2.0 * lengths.size());
  return best;
}

}  // namespace snag
