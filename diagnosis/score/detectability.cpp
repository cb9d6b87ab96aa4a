#include "diagnosis/score/detectability.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace snag {

SignalSize signal_size(const std::vector<double>& signal, const std::vector<double>& variance,
                       const std::vector<std::vector<double>>& columns) {
  const auto n = static_cast<Eigen::Index>(signal.size());
  Eigen::MatrixXd J(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
    J.col(static_cast<Eigen::Index>(c)) = Eigen::Map<const Eigen::VectorXd>(columns[c].data(), n);
  const Eigen::Map<const Eigen::VectorXd> S(signal.data(), n), C(variance.data(), n);
  const Eigen::VectorXd WS = S.cwiseQuotient(C);
  const Eigen::VectorXd b = J.transpose() * WS;
  const Eigen::MatrixXd WJ = C.cwiseInverse().asDiagonal() * J;
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(J.cols(), J.cols()) + J.transpose() * WJ;
  const double d2 = S.dot(WS) - b.dot(A.ldlt().solve(b));
  const Eigen::VectorXd floor = C + J.rowwise().squaredNorm();
  return {std::sqrt(std::max(0.0, d2)), std::sqrt(S.cwiseAbs2().cwiseQuotient(floor).mean())};
}

}  // namespace snag
