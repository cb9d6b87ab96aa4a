#include "diagnosis/localisation/fitted_gap.hpp"

#include <cmath>

#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

/// The eigenvectors of a covariance over the square root of their eigenvalues, those aside that rounding makes: columns whiten what it is
/// of.
Eigen::MatrixXd whitening_of(const Eigen::MatrixXd& covariance) {
  constexpr double rounding = 1e-12;
  // Rows have units of their own.
  const Eigen::VectorXd u = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(u.cwiseInverse().asDiagonal() * covariance * u.cwiseInverse().asDiagonal());
  std::vector<Eigen::Index> known;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (solver.eigenvalues()[i] > rounding) known.push_back(i);
  const Eigen::VectorXd scale = solver.eigenvalues()(known).cwiseSqrt().cwiseInverse();
  return u.cwiseInverse().asDiagonal() * solver.eigenvectors()(Eigen::all, known) * scale.asDiagonal();
}

}  // namespace

FittedGap::FittedGap(const Responses& model, const Fit& fit, const Fit* others) : first_row_(fit.first_row) {
  const Eigen::MatrixXd& J = fit.linear.J;
  const Eigen::Index n = fit.linear.rho.size();
  Eigen::MatrixXd S = Eigen::MatrixXd::Identity(n, n);
  if (J.cols() > 0) S -= J * fit.solution.precision.llt().solve(J.transpose());
  e_ = fit.linear.rho;
  if (J.cols() > 0) e_ += J * fit.solution.d;
  Eigen::VectorXd added = Eigen::VectorXd::Zero(n);  // whitened
  const bool has_shape = others && !others->at.parts.empty() && others->at.parts.size() == others->hypothesis.effects.size();
  Eigen::MatrixXd L = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t p = 0; p + 1 < first_row_.size(); ++p) {
    const int g = model.points()[static_cast<std::size_t>(model.training()[p])].n_gaussian;
    if (g == 0) continue;
    const auto factor = fit.whitening.factor[p].matrixL();
    L.block(first_row_[p], first_row_[p], g, g) = factor;
    if (has_shape)
      for (const auto& part : others->at.parts) added.segment(first_row_[p], g) += factor.solve(part[p].head(g));
  }
  e_ = L * e_;
  covariance_ = L * S * L.transpose();
  if (has_shape) shape_ = L * (S * added);
}

double FittedGap::p_of_any(const std::vector<int>& rows) const {
  const Eigen::MatrixXd W = whitening_of(covariance_(rows, rows));
  return W.cols() > 0 ? chi_squared_tail((W.transpose() * e_(rows)).squaredNorm(), static_cast<double>(W.cols())) : 1;
}

double FittedGap::p_of_mean(const std::vector<int>& rows) const {
  const double variance = covariance_(rows, rows).sum();
  return variance > 0 ? two_sided_p(e_(rows).sum() / std::sqrt(variance)) : 1;
}

double FittedGap::p_of_shape(const std::vector<int>& rows) const {
  if (!has_shape()) return 1;
  const Eigen::MatrixXd W = whitening_of(covariance_(rows, rows));
  const Eigen::VectorXd a = W.transpose() * shape_(rows);
  constexpr double nothing = 1e-3;  // standard deviations
  return a.norm() > nothing ? two_sided_p(a.dot(W.transpose() * e_(rows)) / a.norm()) : 1;
}

}  // namespace snag
