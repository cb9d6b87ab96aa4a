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
  const Eigen::LLT<Eigen::MatrixXd> precision(J.transpose() * J + Eigen::MatrixXd::Identity(J.cols(), J.cols()));
  e_ = fit.linear.rho + J * fit.solution.d;
  by_parameter_ = precision.matrixL().solve(J.transpose()).transpose();
  Eigen::VectorXd added = Eigen::VectorXd::Zero(e_.size());  // whitened
  const bool has_shape = others && !others->at.parts.empty() && others->at.parts.size() == others->hypothesis.effects.size();
  for (std::size_t p = 0; p + 1 < first_row_.size(); ++p) {
    const int g = model.points()[static_cast<std::size_t>(model.training()[p])].n_gaussian;
    if (has_shape && g > 0)
      for (const auto& part : others->at.parts) added.segment(first_row_[p], g) += fit.whitening.factor[p].matrixL().solve(part[p].head(g));
  }
  if (has_shape) shape_ = added - by_parameter_ * (by_parameter_.transpose() * added);
  for (std::size_t p = 0; p + 1 < first_row_.size(); ++p) {
    const int begin = first_row_[p], n = first_row_[p + 1] - begin;
    const int g = model.points()[static_cast<std::size_t>(model.training()[p])].n_gaussian;
    point_of_row_.insert(point_of_row_.end(), static_cast<std::size_t>(n), p);
    Eigen::MatrixXd L = Eigen::MatrixXd::Identity(n, n);
    if (g > 0) L.topLeftCorner(g, g) = fit.whitening.factor[p].matrixL();
    e_.segment(begin, n) = (L * e_.segment(begin, n)).eval();
    by_parameter_.middleRows(begin, n) = (L * by_parameter_.middleRows(begin, n)).eval();
    if (has_shape) shape_.segment(begin, n) = (L * shape_.segment(begin, n)).eval();
    of_point_.push_back(L * L.transpose());
  }
}

Eigen::MatrixXd FittedGap::covariance(const std::vector<int>& rows) const {
  const Eigen::MatrixXd B = by_parameter_(rows, Eigen::all);
  Eigen::MatrixXd covariance = -B * B.transpose();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const std::size_t p = point_of_row_[static_cast<std::size_t>(rows[i])];
      if (point_of_row_[static_cast<std::size_t>(rows[j])] != p) continue;
      covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
          of_point_[p](rows[i] - first_row_[p], rows[j] - first_row_[p]);
    }
  }
  return covariance;
}

double FittedGap::p_of_any(const std::vector<int>& rows) const {
  const Eigen::MatrixXd W = whitening_of(covariance(rows));
  return W.cols() > 0 ? chi_squared_tail((W.transpose() * e_(rows)).squaredNorm(), static_cast<double>(W.cols())) : 1;
}

double FittedGap::p_of_mean(const std::vector<int>& rows) const {
  const double variance = covariance(rows).sum();
  return variance > 0 ? two_sided_p(e_(rows).sum() / std::sqrt(variance)) : 1;
}

double FittedGap::p_of_shape(const std::vector<int>& rows) const {
  if (!has_shape()) return 1;
  const Eigen::MatrixXd W = whitening_of(covariance(rows));
  const Eigen::VectorXd a = W.transpose() * shape_(rows);
  constexpr double nothing = 1e-3;  // standard deviations
  return a.norm() > nothing ? two_sided_p(a.dot(W.transpose() * e_(rows)) / a.norm()) : 1;
}

}  // namespace snag
