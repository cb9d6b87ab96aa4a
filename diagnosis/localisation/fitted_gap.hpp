#pragma once
// What a fit leaves, row by row, with the inputs as fitted once for all rows. With the linear model rho + J d of the fit
// (linear_model.hpp),
//
//   r = rho + J d,   cov(r) = S = 1 - J (J^T J + 1)^-1 J^T,   e = L r,   cov(e) = L S L^T,   C = L L^T,
//
// e is measured less simulated, and of some rows c together, on k of them,
//
//   T = e_c^T cov(e_c)^-1 e_c ~ chi2(k)                                      anything that is off in them
//   z = a_c^T cov(e_c)^-1 e_c / sqrt(a_c^T cov(e_c)^-1 a_c) ~ N(0, 1)         what would look like a = L S L^-1 p there
//
// p: what other effects add to f. The second is the most powerful test for a difference of a known shape (matched filter; Neyman and
// Pearson's lemma for Gaussian rows). A row with a likelihood of its own counts by its deviance residual, with L = 1.
#include <Eigen/Dense>
#include <vector>

#include "diagnosis/fitting/fit.hpp"

namespace snag {

class FittedGap {
 public:
  /// `others`: whose effects are the shape that is looked for; null: none.
  FittedGap(const Responses& model, const Fit& fit, const Fit* others = nullptr);

  /// Rows are counted over all training points.
  int row(std::size_t training_point, int row) const { return first_row_[training_point] + row; }
  bool has_shape() const { return shape_.size() > 0; }
  /// Of T.
  double p_of_any(const std::vector<int>& rows) const;
  /// Two-sided, of the mean of e; rows of one unit.
  double p_of_mean(const std::vector<int>& rows) const;
  /// Two-sided, of z; 1 where the shape is nothing there.
  double p_of_shape(const std::vector<int>& rows) const;
  double mean(const std::vector<int>& rows) const { return e_(rows).mean(); }
  /// e, and its covariance.
  Eigen::VectorXd left(const std::vector<int>& rows) const { return e_(rows); }
  Eigen::MatrixXd covariance(const std::vector<int>& rows) const;

 private:
  std::vector<int> first_row_;
  Eigen::VectorXd e_, shape_;
  Eigen::MatrixXd by_parameter_;           // B = L J R^-1 with R^T R = J^T J + 1: cov(e) = C - B B^T
  std::vector<Eigen::MatrixXd> of_point_;  // C
  std::vector<std::size_t> point_of_row_;
};

}  // namespace snag
