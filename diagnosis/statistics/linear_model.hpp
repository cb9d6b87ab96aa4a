#pragma once
// A linear model with Gaussian priors, some parameters within bounds:
//
//   Phi(d) = 1/2 |rho + J d|^2 + 1/2 |d - prior|^2,   lower <= d_i <= upper for the first n_bounded parameters
//
// and its evidence, the integral of exp(-Phi) over d and its prior. Every parameter has unit prior variance.
#include <Eigen/Dense>

namespace snag {

struct LinearModel {
  Eigen::VectorXd rho;           // whitened residual at d = 0
  Eigen::MatrixXd J;             // its derivative, bounded parameters first
  Eigen::VectorXd prior;         // means of the priors of d
  Eigen::VectorXd lower, upper;  // of the bounded ones
};

struct LinearSolution {
  Eigen::VectorXd d;           // where Phi is least
  double objective = 0;        // Phi there
  double log_evidence = 0;     // without the terms of the covariance that whitened rho
  Eigen::MatrixXd precision;   // J^T J + 1
  Eigen::MatrixXd covariance;  // its inverse
};

LinearSolution solve(const LinearModel& model);
/// The same from J^T J, J^T rho and |rho|^2.
LinearSolution solve(const Eigen::MatrixXd& JtJ, const Eigen::VectorXd& Jt_rho, double rho_square, const Eigen::VectorXd& prior,
                     const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

/// log of the integral of exp(-g x - a x^2/2) from lower to upper, a > 0; also far in the tails.
double log_truncated_gaussian(double g, double a, double lower, double upper);

/// log of the integral of exp(-g.x - x.A x/2) over the box, A positive definite. Of two parameters by quadrature; of more, one after the
/// other is integrated out, the one with the least mass within its bounds first, and what it leaves of the others is taken as Gaussian
/// again, with the mean and variance that the truncation gives: exact for independent parameters and for those far from their bounds.
/// Source: Mendell and Elston (1974), Biometrics 30, 41-57.
double log_box_integral(const Eigen::VectorXd& g, const Eigen::MatrixXd& A, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

/// A standard normal number between two bounds, as the uniform number in [0, 1) picks it, and the logarithm of the mass between them; also
/// far in the tails.
struct TruncatedDraw {
  double value = 0, log_mass = 0;
};
TruncatedDraw truncated_normal_draw(double lower, double upper, double uniform);

}  // namespace snag
