#include <cmath>
#include <numbers>

#include "diagnosis/attribution/attribution.hpp"

namespace snag {

double leave_one_out(const Fit& fit) {
  double sum = 0;
  const Eigen::VectorXd& rho = fit.linear.rho;
  const Eigen::MatrixXd& J = fit.linear.J;
  for (std::size_t p = 0; p + 1 < fit.first_row.size(); ++p) {
    const int begin = fit.first_row[p], n = fit.first_row[p + 1] - begin;
    if (n == 0) continue;
    const auto own = J.middleRows(begin, n);
    const auto own_rho = rho.segment(begin, n);
    const Eigen::MatrixXd JtJ = J.transpose() * J - own.transpose() * own;
    const Eigen::VectorXd Jt_rho = J.transpose() * rho - own.transpose() * own_rho;
    const LinearSolution others =
        solve(JtJ, Jt_rho, rho.squaredNorm() - own_rho.squaredNorm(), fit.linear.prior, fit.linear.lower, fit.linear.upper);
    const Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd::Identity(n, n) + own * others.covariance * own.transpose());
    const Eigen::VectorXd z = factor.matrixL().solve(own_rho + own * others.d);
    const Eigen::MatrixXd &L = factor.matrixLLT(), &C = fit.whitening.factor[p].matrixLLT();
    sum -= 0.5 * z.squaredNorm() + 0.5 * fit.whitening.log_ratio[p] + L.diagonal().array().log().sum() + C.diagonal().array().log().sum() +
           0.5 * n * std::log(2 * std::numbers::pi);
  }
  return sum;
}

}  // namespace snag
