// Requirement: how clear an effect is of nothing is what the fit loses without it, also where the forms of its law leave its strength open.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/fitting/fit.hpp"

namespace snag {
namespace {

/// Rows y - theta (a + xi (b - a)/3) - nu c of unit noise: an effect with two forms, and an input. theta has next to no prior.
struct Rows {
  Eigen::VectorXd y, a, b, c;

  Eigen::VectorXd residual(const Eigen::Vector3d& x) const { return y - x[0] * (a + x[2] / 3 * (b - a)) - x[1] * c; }
  double phi(const Eigen::Vector3d& x) const { return 0.5 * residual(x).squaredNorm() + 0.5 * (x[1] * x[1] + x[2] * x[2]); }
  Eigen::MatrixXd derivative(const Eigen::Vector3d& x) const {
    Eigen::MatrixXd J(y.size(), 3);
    J << -(a + x[2] / 3 * (b - a)), -c, -x[0] / 3 * (b - a);
    return J;
  }
  Eigen::Vector3d fitted() const {
    Eigen::Vector3d x(1, 0, 0);
    for (int i = 0; i < 200; ++i) {
      const Eigen::MatrixXd J = derivative(x);
      Eigen::Matrix3d H = J.transpose() * J;
      H(1, 1) += 1, H(2, 2) += 1;
      x -= H.llt().solve(J.transpose() * residual(x) + Eigen::Vector3d(0, x[1], x[2]));
    }
    return x;
  }
  /// Without the effect: the input alone.
  double phi_of_none() const {
    const double nu = c.dot(y) / (1 + c.squaredNorm());
    return phi({0, nu, 0});
  }
};

constexpr double wide = 1e4;  // prior standard deviation of the strength

Fit fit_of(const Rows& rows) {
  const Eigen::Vector3d x = rows.fitted();
  Fit fit;
  fit.hypothesis.effects = {0};
  fit.at.state = {{{0, x[0]}}, Eigen::VectorXd::Constant(1, x[1]), {0}, Eigen::VectorXd::Constant(1, x[2])};
  fit.linear = {rows.residual(x), rows.derivative(x), -Eigen::Vector3d(0, x[1], x[2]), Eigen::VectorXd::Constant(1, -wide),
                Eigen::VectorXd::Constant(1, wide)};
  fit.linear.J.col(0) *= wide;
  fit.solution = solve(fit.linear);
  fit.theta = Eigen::VectorXd::Constant(1, x[0]);
  fit.theta_sd = Eigen::VectorXd::Constant(1, wide * std::sqrt(fit.solution.covariance(0, 0)));
  return fit;
}

TEST(ClearOfNothing, IsWhatTheFitLosesWithoutTheEffect) {
  const std::vector<Effect> effects{{.name = "lift", .parameter = "", .sd = wide, .minimum = -wide, .maximum = wide, .n_forms = 2}};
  for (const double strength : {1.0, 3.0}) {
    Rows rows{Eigen::VectorXd(40), Eigen::VectorXd(40), Eigen::VectorXd(40), Eigen::VectorXd(40)};
    for (int i = 0; i < 40; ++i) {
      const double t = i / 39.0;
      // The other form pushes the other way, in hardly another shape.
      rows.a[i] = 6 * t * t, rows.b[i] = -1.2 * rows.a[i] + 0.2 * std::sin(20 * t), rows.c[i] = 2 * t;
      rows.y[i] = strength * rows.a[i] + 0.3 * rows.c[i] + 0.5 * std::sin(37 * i);
    }
    const Fit fit = fit_of(rows);
    const double exact = std::sqrt(2 * (rows.phi_of_none() - rows.phi(rows.fitted())));
    EXPECT_NEAR(clear_of_nothing(fit, 0, effects) / exact, 1, 0.02) << strength;
    EXPECT_LT(fit.theta[0] / fit.theta_sd[0], 0.6 * exact) << strength;  // the strength itself is known less well
  }
}

}  // namespace
}  // namespace snag
