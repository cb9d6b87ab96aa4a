#pragma once
// Weak form of paths: what a path x(t), measured less simulated, says of the force that is missing, without a derivative of noise. With a
// test function phi that vanishes with its derivatives at both ends,
//
//   a_phi = integral of x phi'' dt = integral of x'' phi dt,   phi = (1 - s^2)^4,   s = (t - c)/h,   scaled so that x = t^2/2 gives 1:
//
// the mean missing acceleration about the time c, in m/s2. Offsets and drifts (a calibration, a start that is off) fall out.
// Source: Bortz, Messenger and Dukic (2023), Bull. Math. Biol. 85, 110 (weak form); Brunton, Proctor and Kutz (2016), PNAS 113, 3932.
#include <Eigen/Dense>
#include <vector>

#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// Test functions over samples at these times, one a row: half as wide as a third of the samples, each half a width from the next; none for
/// fewer than 7 samples. Exact for parabolas at any times.
Eigen::MatrixXd test_functions(const std::vector<double>& times);

/// Takes whitened rows of all training points to weak rows of their paths of positions (x, y, z), whitened anew.
class WeakForm {
 public:
  WeakForm(const Responses& model, const Whitening& whitening);
  Eigen::Index size() const { return size_; }  // 0: no path is long enough
  Eigen::VectorXd operator()(const Eigen::VectorXd& whitened) const;

 private:
  struct Block {
    Eigen::Index first = 0;  // row of the point
    Eigen::MatrixXd weak;
  };
  std::vector<Block> blocks_;
  Eigen::Index size_ = 0;
};

}  // namespace snag
