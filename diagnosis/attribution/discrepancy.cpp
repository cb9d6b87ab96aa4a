#include "diagnosis/attribution/discrepancy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "diagnosis/attribution/discrepancy_shape.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr std::array amplitudes{0.0, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0};
constexpr std::array is_off{0.0, 1.0};

class GaussianProcess {
 public:
  GaussianProcess(const Responses& model, const Linearization& at, const Linearization& base)
      : model_(model), expanded_at_(at.state.nuisances) {
    const auto& training = model.training();
    n_parts_ = static_cast<int>(model.experiment().observables.size()) + 1;
    for (std::size_t p = 0; p < training.size(); ++p) {
      const PointSummary& point = model.points()[training[p]];
      const int g = point.n_gaussian, n = static_cast<int>(point.rows.size());
      Block block{
          &point, Eigen::MatrixXd::Identity(n, n), {}, Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(at.by_nuisance.size())), {}, {}};
      block.covariance.topLeftCorner(g, g) = model_covariance(point, at.responses[p], at.numerical_error[p], {});
      // Gaussian rows in their own units, the others as deviance residuals of unit variance.
      const Eigen::LLT<Eigen::MatrixXd> none(Eigen::MatrixXd::Identity(g, g));
      const Eigen::VectorXd origin = residual(point, at.origin[p], none);
      for (std::size_t j = 0; j < at.by_nuisance.size(); ++j) {
        if (at.by_nuisance[j][p].value.size() > 0)
          block.nuisances.col(static_cast<Eigen::Index>(j)) = (residual(point, at.by_nuisance[j][p], none) - origin) / nuisance_step;
      }
      block.difference = residual(point, at.responses[p], none) - block.nuisances * expanded_at_;
      block.range = ranges(point, base.responses[p]);
      for (const DiscrepancyShape& shape : discrepancy_shapes) block.correlation.push_back(discrepancy_correlation(point, shape));
      n_gaussian_ += g;
      log_ratio_ += log_variance_ratio(point, at.responses[p]);
      blocks_.push_back(std::move(block));
    }
  }

  struct Marginal {
    double log_evidence = 0;
    Eigen::VectorXd nuisances;  // the likeliest, in standard uncertainties
  };
  Marginal marginal(const Discrepancy& process) const {
    const Eigen::Index m = expanded_at_.size();
    Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(m, m);
    Eigen::VectorXd projected = Eigen::VectorXd::Zero(m);
    double value = -0.5 * n_gaussian_ * std::log(2 * std::numbers::pi) - 0.5 * log_ratio_;
    for (const Block& block : blocks_) {
      const Eigen::LLT<Eigen::MatrixXd> factor(covariance(block, process));
      const Eigen::VectorXd r = factor.matrixL().solve(block.difference);
      const Eigen::MatrixXd J = factor.matrixL().solve(block.nuisances);
      const Eigen::MatrixXd& L = factor.matrixLLT();
      value -= 0.5 * r.squaredNorm() + L.diagonal().array().log().sum();
      precision += J.transpose() * J, projected += J.transpose() * r;
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(precision);
    const Eigen::MatrixXd& L = factor.matrixLLT();
    const Eigen::VectorXd nuisances = -factor.solve(projected);
    return {value - 0.5 * projected.dot(nuisances) - L.diagonal().array().log().sum(), nuisances};
  }

  /// How far the likeliest inputs of the best process are from those that the linear model was made at, in standard uncertainties.
  double reach(const Discrepancy& best) const {
    if (!std::isfinite(best.log_evidence)) return std::numeric_limits<double>::infinity();
    return expanded_at_.size() == 0 ? 0 : (best.nuisances - expanded_at_).cwiseAbs().maxCoeff();
  }

  /// The best process of the grid, with the evidence of all of it.
  Discrepancy fit() const {
    Discrepancy best{-std::numeric_limits<double>::infinity(), 0, std::vector<double>(n_parts_, 0.0), expanded_at_};
    const auto better_of = [&](const Discrepancy& tried) {
      const Marginal found = marginal(tried);
      if (found.log_evidence > best.log_evidence) best = {found.log_evidence, tried.shape, tried.amplitude, found.nuisances};
    };
    for (std::size_t shape = 0; shape < discrepancy_shapes.size(); ++shape)
      for (std::size_t a = 1; a < amplitudes.size(); ++a) {
        std::vector<double> amplitude(n_parts_, amplitudes[a]);
        amplitude.back() = 0;
        better_of({0, shape, amplitude});
      }
    // Inputs that no effect leaves so far off that nothing runs there say nothing of any process.
    if (!std::isfinite(best.log_evidence)) return best;
    // Then each observable may choose its own amplitude.
    for (int sweep = 0; sweep < 2; ++sweep) {
      for (int o = 0; o < n_parts_; ++o)
        for (const Discrepancy& other : with_other_amplitude(best, o)) better_of(other);
      for (const Discrepancy& other : with_other_shape(best)) better_of(other);
    }
    // Each choice of the grid has its share of the prior; what the others bring is taken one choice at a time.
    double log_evidence = best.log_evidence;
    for (int o = 0; o < n_parts_; ++o) log_evidence += log_mean(with_other_amplitude(best, o), choices(o).size(), best);
    best.log_evidence = log_evidence + log_mean(with_other_shape(best), discrepancy_shapes.size(), best);
    return best;
  }

 private:
  struct Block {
    const PointSummary* point;
    Eigen::MatrixXd covariance;
    Eigen::VectorXd difference;
    Eigen::MatrixXd nuisances;
    std::vector<double> range;                 // by row
    std::vector<Eigen::MatrixXd> correlation;  // by shape, between the Gaussian rows
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

  // Spreads are as expected or not.
  std::span<const double> choices(int part) const {
    return part + 1 < n_parts_ ? std::span<const double>(amplitudes) : std::span<const double>(is_off);
  }
  // With another amplitude of one observable; at least one keeps one, or it would be the base model.
  std::vector<Discrepancy> with_other_amplitude(const Discrepancy& best, int part) const {
    std::vector<Discrepancy> others;
    for (const double amplitude : choices(part)) {
      Discrepancy other = best;
      other.amplitude[part] = amplitude;
      if (std::any_of(other.amplitude.begin(), other.amplitude.end(), [](double s) { return s > 0; })) others.push_back(other);
    }
    return others;
  }
  static std::vector<Discrepancy> with_other_shape(const Discrepancy& best) {
    std::vector<Discrepancy> others;
    for (std::size_t shape = 0; shape < discrepancy_shapes.size(); ++shape) {
      others.push_back(best);
      others.back().shape = shape;
    }
    return others;
  }
  /// log of the mean over n choices of exp(evidence), over that of the best.
  double log_mean(const std::vector<Discrepancy>& choices, std::size_t n, const Discrepancy& best) const {
    std::vector<double> gains;
    for (const Discrepancy& choice : choices) gains.push_back(marginal(choice).log_evidence - best.log_evidence);
    return log_sum_exp(gains) - std::log(static_cast<double>(n));
  }

  static Eigen::MatrixXd covariance(const Block& block, const Discrepancy& process) {
    const auto& amplitude = process.amplitude;
    Eigen::MatrixXd K = block.covariance;
    const auto& rows = block.point->rows;
    for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
      // What moves the mean of the replicates may leave them as far apart as they were.
      if ((rows[i].kind == Row::Kind::spread ? amplitude.back() : amplitude[rows[i].observable]) == 0) continue;
      constexpr double deviance_scale = 3;
      if (!is_gaussian(rows[i])) K(i, i) += deviance_scale * deviance_scale;
      if (!is_gaussian(rows[i])) continue;
      for (int j = 0; j < block.point->n_gaussian; ++j) {
        const double s = amplitude[rows[i].observable];
        K(i, j) += s * block.range[i] * s * block.range[j] * block.correlation[process.shape](i, j);
      }
    }
    return K;
  }

  const Responses& model_;
  Eigen::VectorXd expanded_at_;  // nuisances of the linear model
  std::vector<Block> blocks_;
  int n_parts_ = 0, n_gaussian_ = 0;  // parts: the observables, and the spreads between replicates
  double log_ratio_ = 0;              // of the rows that are not Gaussian
};

}  // namespace

Discrepancy fit_discrepancy(const Responses& model, Fitter& fitter, const Fit& none) {
  const GaussianProcess at_base(model, fitter.base(), fitter.base()), at_none(model, none.at, fitter.base());
  const Discrepancy from_base = at_base.fit(), from_none = at_none.fit();
  // Inputs are not linear as far as they may have to go: the linear model nearest to where it leads is the one to go by, and one made
  // there is better.
  const double reach_of_base = at_base.reach(from_base), reach_of_none = at_none.reach(from_none);
  const Discrepancy& nearer = reach_of_base < reach_of_none ? from_base : from_none;
  constexpr double near = 0.5;  // standard uncertainties
  if (std::min(reach_of_base, reach_of_none) < near ||
      fitter.runs_left() < fitter.runs_of_fit(0) * static_cast<int>(model.training().size()))
    return nearer;
  State state = model.base();
  state.nuisances = nearer.nuisances;
  const Linearization there = fitter.linearize(state, {});
  // What does not run there is five standard uncertainties off by convention (residual), which is near where the data have another unit.
  const bool runs = std::all_of(there.responses.begin(), there.responses.end(), [](const Response& r) { return r.failure.empty(); });
  return runs ? GaussianProcess(model, there, fitter.base()).fit() : nearer;
}

}  // namespace snag
