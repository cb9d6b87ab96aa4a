#pragma once
// How stiffly its contacts hold a particle: the blocks of the linearised equations of motion of the particle alone.
//
// Contact c has the normal n, the arm a from the centre, over the radius r, and over the reduced mass the normal and tangential
// coefficients s_n, s_t: each of StepRates in turn. With the displacement u and the rotation w r sqrt(I/(m r^2)) of the particle as
// unknowns, q = m r^2/I, it is strained by u + sqrt(q) w x a, and the block of the particle is
//
//   A = [ T  B ]    S = s_n n n' + s_t (1 - n n')     T = sum S     B = sqrt(q) sum S [a x]'     R = q sum [a x] S [a x]'
//       [ B' R ]
//   largest eigenvalue of A <= (t + r)/2 + sqrt((t - r)^2/4 + b^2),   t, r: of T and R,  b: largest singular value of B
//
// A contact under the strain y_1 + y_2, y_i by the motion of body i, has the energy (y_1 + y_2)^2 k/2 <= k/2 (m_1 y_1^2 + m_2 y_2^2)/m*.
// Coefficients over the reduced mass m* therefore make the largest eigenvalue over all particles a bound of that of the whole system.
#include <Eigen/Eigenvalues>

#include "dem/contacts/contact_law.hpp"

namespace snag {

class HeldParticle {
 public:
  /// `arm`: over the radius of the particle.
  void add(const Vec3& n, const ContactRates& rates, const Vec3& arm) {
    stiffness_.add(n, rates.normal.stiffness, rates.tangential.stiffness, arm);
    damping_.add(n, rates.normal.damping, rates.tangential.damping, arm);
    share_.add(n, rates.normal.share, rates.tangential.share, arm);
  }
  /// Whether any contact holds it.
  bool is_held() const { return stiffness_.coarse > 0 || damping_.coarse > 0; }
  /// Bound of the rates, and a coarser one that takes little time.
  StepRates rates() const { return {stiffness_.bound(), damping_.bound(), share_.bound()}; }
  StepRates coarse_rates() const { return {stiffness_.coarse, damping_.coarse, share_.coarse}; }

 private:
  static constexpr double q = turning_sphere - 1;

  struct Sums {
    Eigen::Matrix3d T = Eigen::Matrix3d::Zero(), B = Eigen::Matrix3d::Zero(), R = Eigen::Matrix3d::Zero();
    double coarse = 0;  // sum over the contacts of the largest eigenvalue of each alone

    void add(const Vec3& direction, double s_n, double s_t, const Vec3& arm) {
      if (s_n + s_t == 0) return;
      const Eigen::Vector3d n{direction.x, direction.y, direction.z};
      Eigen::Matrix3d turned;  // sqrt(q) [a x]
      turned << 0, -arm.z, arm.y, arm.z, 0, -arm.x, -arm.y, arm.x, 0;
      turned *= std::sqrt(q);
      const Eigen::Matrix3d S = (s_n - s_t) * n * n.transpose() + s_t * Eigen::Matrix3d::Identity(), across = S * turned.transpose();
      T += S, B += across, R += turned * across;
      const double along = dot(arm, direction), square = norm_squared(arm);
      coarse += s_n * (1 + q * std::max(square - along * along, 0.0)) + s_t * (1 + q * square);
    }
    static double largest_eigenvalue(const Eigen::Matrix3d& m) {
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
      return solver.computeDirect(m, Eigen::EigenvaluesOnly).eigenvalues()(2);
    }
    double bound() const {
      if (coarse == 0) return 0;
      const double t = largest_eigenvalue(T), r = largest_eigenvalue(R), b_squared = largest_eigenvalue(B.transpose() * B);
      return std::min(0.5 * (t + r) + std::sqrt(0.25 * (t - r) * (t - r) + std::max(b_squared, 0.0)), coarse);
    }
  };
  Sums stiffness_, damping_, share_;
};

}  // namespace snag
