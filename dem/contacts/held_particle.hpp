#pragma once
// How stiffly its contacts hold a particle: the blocks of the linearised equations of motion of the particle alone.
//
// Contact c has the normal n and, over the reduced mass, the normal and tangential coefficients s_n, s_t: each of StepRates in turn. With
// the displacement u and the rotation w r sqrt(I/(m r^2)) of the particle as unknowns, q = m r^2/I, its block is
//
//   A = [ T  B ]    T = sum s_n n n' + s_t (1 - n n')     R = q sum s_t (1 - n n')     B = sqrt(q) sum s_t [n x]
//       [ B' R ]
//   largest eigenvalue of A <= (t + r)/2 + sqrt((t - r)^2/4 + b^2),   t, r: of T and R,  b = sqrt(q) |sum s_t n|
//
// A contact under the strain y_1 + y_2, y_i by the motion of body i, has the energy (y_1 + y_2)^2 k/2 <= k/2 (m_1 y_1^2 + m_2 y_2^2)/m*.
// Coefficients over the reduced mass m* therefore make the largest eigenvalue over all particles a bound of that of the whole system.
#include <Eigen/Eigenvalues>

#include "dem/contacts/contact_law.hpp"

namespace snag {

class HeldParticle {
 public:
  void add(const Vec3& n, const ContactRates& rates) {
    stiffness_.add(n, rates.normal.stiffness, rates.tangential.stiffness);
    damping_.add(n, rates.normal.damping, rates.tangential.damping);
    share_.add(n, rates.normal.share, rates.tangential.share);
  }
  /// Whether any contact holds it.
  bool is_held() const { return stiffness_.coarse_bound() > 0 || damping_.coarse_bound() > 0; }
  /// Bound of the rates, and a coarser one that takes little time.
  StepRates rates() const { return {stiffness_.bound(), damping_.bound(), share_.bound()}; }
  StepRates coarse_rates() const { return {stiffness_.coarse_bound(), damping_.coarse_bound(), share_.coarse_bound()}; }

 private:
  static constexpr double q = turning_sphere - 1;

  struct Sums {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), tangential = Eigen::Matrix3d::Zero();  // sums of s_n n n', s_t n n'
    Eigen::Vector3d arm = Eigen::Vector3d::Zero();                                           // sum of s_t n

    void add(const Vec3& direction, double s_n, double s_t) {
      const Eigen::Vector3d n{direction.x, direction.y, direction.z};
      const Eigen::Matrix3d nn = n * n.transpose();
      normal += s_n * nn, tangential += s_t * nn, arm += s_t * n;
    }
    static double largest_eigenvalue(const Eigen::Matrix3d& m) {
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
      return solver.computeDirect(m, Eigen::EigenvaluesOnly).eigenvalues()(2);
    }
    double bound() const {
      const Eigen::Matrix3d across = tangential.trace() * Eigen::Matrix3d::Identity() - tangential;
      const double t = largest_eigenvalue(normal + across), r = q * largest_eigenvalue(across);
      return 0.5 * (t + r) + std::sqrt(0.25 * (t - r) * (t - r) + q * arm.squaredNorm());
    }
    double coarse_bound() const { return normal.trace() + turning_sphere * tangential.trace(); }
  };
  Sums stiffness_, damping_, share_;
};

}  // namespace snag
