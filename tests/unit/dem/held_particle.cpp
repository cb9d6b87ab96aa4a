// Bound of the eigenvalues of a particle under its contacts, and the step that follows.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // false alarm of GCC 12 in its own AVX-512 headers, bug 105593
#endif
#include "dem/contacts/held_particle.hpp"

#include <gtest/gtest.h>

#include <random>

namespace snag {
namespace {

struct Contact {
  Vec3 n, arm;
};

/// The block A of dem/contacts/held_particle.hpp, of stiffness alone, written out: a contact strains its normal spring by n.y and its
/// tangential one by (1 - n n') y, y = u + sqrt(q) w x a.
double largest_eigenvalue(const std::vector<Contact>& contacts, double s_n, double s_t) {
  using Row = Eigen::Matrix<double, 3, 6>;
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Contact& contact : contacts) {
    const Eigen::Vector3d n(contact.n.x, contact.n.y, contact.n.z), a(contact.arm.x, contact.arm.y, contact.arm.z);
    Row strain;
    for (int i = 0; i < 3; ++i) {
      strain.col(i) = Eigen::Vector3d::Unit(i);
      strain.col(3 + i) = std::sqrt(turning_sphere - 1) * Eigen::Vector3d::Unit(i).cross(a);
    }
    const Row along = n * (n.transpose() * strain), across = strain - along;
    sum += s_n * along.transpose() * along + s_t * across.transpose() * across;
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(sum, Eigen::EigenvaluesOnly).eigenvalues()(5);
}

HeldParticle held_by(const std::vector<Contact>& contacts, double s_n, double s_t) {
  HeldParticle particle;
  for (const Contact& c : contacts) particle.add(c.n, {.normal = {s_n, 0, 0}, .tangential = {s_t, 0, 0}}, c.arm);
  return particle;
}

TEST(HeldParticle, OneContactIsExact) {
  // Requirement: without a stiffer normal spring one contact gives 3.5 s_t, the sliding and rolling of a sphere on its own.
  const HeldParticle particle = held_by({{{0.6, 0, 0.8}, {0.6, 0, 0.8}}}, 1, 2);
  EXPECT_NEAR(particle.rates().stiffness, turning_sphere * 2, 1e-6);  // closed-form eigenvalues are good to the root of round-off
  EXPECT_EQ(particle.rates().damping, 0);
}

TEST(HeldParticle, BoundsTheEigenvaluesOfManyContacts) {
  // Requirement: for any contacts, wherever on the cloth around the particle, the bound is not below the largest eigenvalue and at most
  // half above it, and not above the coarse one.
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  double most = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Contact> contacts;
    const auto any = [&] { return Vec3{normal(generator), normal(generator), normal(generator)}; };
    for (int c = 0; c < 1 + trial % 9; ++c) {
      const Vec3 n = unit(any()), beside = trial % 2 == 0 ? Vec3{} : 0.5 * any();
      contacts.push_back({n, n + beside});
    }
    const double s_n = 0.2 + trial % 5, exact = largest_eigenvalue(contacts, s_n, 1);
    const HeldParticle particle = held_by(contacts, s_n, 1);
    EXPECT_GE(particle.rates().stiffness, exact * (1 - 1e-7)) << trial;
    EXPECT_LE(particle.rates().stiffness, 1.5 * exact) << trial;
    EXPECT_GE(particle.coarse_rates().stiffness, particle.rates().stiffness * (1 - 1e-7)) << trial;
    most = std::max(most, particle.rates().stiffness / exact);
  }
  EXPECT_GT(most, 1.01) << "the trials are too simple to tell a bound from the value";
}

TEST(StepRates, StepSolvesItsEquation) {
  // Requirement: dt^2/4 K + dt/2 C + S = 1 at the step.
  for (const StepRates& r : {StepRates{1e8, 0, 0}, {1e8, 1e4, 0}, {1e8, 1e6, 0.3}, {0, 1e4, 0.5}}) {
    const double dt = r.step();
    EXPECT_NEAR(dt * dt / 4 * r.stiffness + dt / 2 * r.damping + r.share, 1, 1e-12);
  }
  EXPECT_TRUE(std::isinf(StepRates{}.step()));
}

TEST(StepRates, EasedDashpotsLeaveRoomForEight) {
  // Requirement: whatever the dashpot, dt/2 q c'/m* stays below 1/8; for short steps it is the dashpot.
  for (const double c : {1e-3, 1.0, 1e3})
    for (const double dt : {1e-12, 1e-6, 1e-3}) {
      const double mass = 2e-6, part = turning_sphere * tangential_rates(0, c, mass, dt).share;
      EXPECT_LT(part, 1 / easing_contacts);
    }
  EXPECT_NEAR(eased(1e-3, dashpot_easing(2e-6), 1e-12), 1e-3, 1e-10);
}

}  // namespace
}  // namespace snag
