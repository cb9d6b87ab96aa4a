// The elastic bond of one pair: derivative of its energy, symmetric, objective, momentum kept, and the incremental law for small strains.
#include "dem/bonds/bond_law.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "dem/templates/lattice.hpp"

namespace snag {
namespace {

Rag cloth() {
  Rag rag;
  rag.n_columns = 2, rag.n_rows = 2, rag.radius = 1e-3, rag.mass = 2.25e-6, rag.inertia = 0.4 * rag.mass * 1e-6;
  rag.bond[0] = {7.65e8, 5e6, 3.86e7, 0, 0}, rag.bond[1] = {4.23e8, 5e6, 1.03e7, 0, 0};
  return rag;
}

struct Pose {
  Vec3 x, v, w;
  Quaternion q;
};

template <int direction>
BondEnd end_of(const Pose& p) {
  return {p.x, p.v, p.w, p.q.w, p.q.x, p.q.y, p.q.z, carried_direction<direction>(p.q.w, p.q.x, p.q.y, p.q.z)};
}

template <int direction, bool damped>
BondForce evaluate(const BondCoefficients& law, const Pose& one, const Pose& two) {
  return bond_force<direction, damped>(law, end_of<direction>(one), end_of<direction>(two));
}

double energy(const BondForce& b) { return b.energy_parts[0] + b.energy_parts[1] + b.energy_parts[2] + b.energy_parts[3]; }

struct Random {
  std::mt19937_64 engine{7};
  double operator()() { return std::uniform_real_distribution<double>(-1, 1)(engine); }
  Vec3 vector(double scale) { return scale * Vec3{(*this)(), (*this)(), (*this)()}; }
};

/// Two ends far from rest: stretched by tens of per cent, bent and twisted by up to about a radian, turned at will.
std::pair<Pose, Pose> random_pair(Random& random, int direction) {
  const double l0 = 2e-3;
  Pose one{random.vector(0.1), random.vector(1), random.vector(500), rotation_by(random.vector(3))};
  const Vec3 along = rotate(one.q, direction == 0 ? Vec3{l0, 0, 0} : Vec3{0, l0, 0});
  Pose two{one.x + along + random.vector(0.3 * l0), random.vector(1), random.vector(500), product(rotation_by(random.vector(0.8)), one.q)};
  return {one, two};
}

template <int direction>
void check_gradient() {
  // Requirement: elastic forces and torques are minus the derivative of the energy.
  const BondCoefficients law = bonds_of(cloth())->coefficients(direction);
  Random random;
  for (int sample = 0; sample < 20; ++sample) {
    const auto [one, two] = random_pair(random, direction);
    const BondForce bond = evaluate<direction, false>(law, one, two);
    const auto U = [&](const Pose& a, const Pose& b) { return energy(evaluate<direction, false>(law, a, b)); };
    for (int c = 0; c < 3; ++c) {
      Vec3 e;
      e[c] = 1;
      const double dx = 1e-8, dw = 1e-5;
      Pose a = two, b = two;
      a.x += dx * e, b.x -= dx * e;
      EXPECT_NEAR(-(U(one, a) - U(one, b)) / (2 * dx), bond.force[c], 1e-6 * norm(bond.force));
      a = two, b = two, a.q = product(rotation_by(dw * e), two.q), b.q = product(rotation_by(-dw * e), two.q);
      EXPECT_NEAR(-(U(one, a) - U(one, b)) / (2 * dw), bond.torque2[c], 1e-6 * norm(bond.torque2));
      a = one, b = one, a.q = product(rotation_by(dw * e), one.q), b.q = product(rotation_by(-dw * e), one.q);
      EXPECT_NEAR(-(U(a, two) - U(b, two)) / (2 * dw), bond.torque1[c], 1e-6 * norm(bond.torque1));
    }
  }
}

TEST(ElasticBond, IsTheDerivativeOfItsEnergy) {
  check_gradient<0>();
  check_gradient<1>();
}

template <int direction>
void check_pair_laws() {
  const BondCoefficients law = bonds_of(cloth())->coefficients(direction);
  Random random;
  for (int sample = 0; sample < 50; ++sample) {
    const auto [one, two] = random_pair(random, direction);
    const BondForce bond = evaluate<direction, true>(law, one, two);
    const double force = norm(bond.force), moment = norm(bond.torque1) + norm(bond.torque2) + force * bond.length;

    // Requirement: the total angular momentum of the pair is kept to round-off.
    EXPECT_LT(norm(bond.torque1 + bond.torque2 + cross(two.x - one.x, bond.force)), 1e-14 * moment);

    // Requirement: numbering the ends the other way round gives the same forces. The lattice direction then points from the second end to
    // the first, as if both ends were turned by pi about an axis across the bond before birth.
    const Quaternion flip = direction == 0 ? Quaternion{0, 0, 1, 0} : Quaternion{0, 1, 0, 0};
    Pose first = two, second = one;
    first.q = product(two.q, flip), second.q = product(one.q, flip);
    const BondForce other = evaluate<direction, true>(law, first, second);
    EXPECT_LT(norm(other.force + bond.force), 2e-15 * law.normal * law.length);
    EXPECT_LT(norm(other.torque1 - bond.torque2), 4e-15 * moment);
    EXPECT_LT(norm(other.torque2 - bond.torque1), 4e-15 * moment);

    // Requirement: turning and shifting both ends turns forces and torques with them, at any steady rotation.
    const Quaternion Q = rotation_by(random.vector(2));
    const Vec3 shift = random.vector(0.05), spin = random.vector(300);
    const auto moved = [&](const Pose& p) {
      const Vec3 x = rotate(Q, p.x) + shift;
      return Pose{x, rotate(Q, p.v) + cross(spin, x), rotate(Q, p.w) + spin, product(Q, p.q)};
    };
    const BondForce turned = evaluate<direction, true>(law, moved(one), moved(two));
    EXPECT_LT(norm(turned.force - rotate(Q, bond.force)), 1e-12 * law.normal * law.length);
    EXPECT_LT(norm(turned.torque1 - rotate(Q, bond.torque1)), 1e-12 * moment);
    EXPECT_LT(norm(turned.torque2 - rotate(Q, bond.torque2)), 1e-12 * moment);

    // Requirement: dashpots and friction only take energy.
    const BondForce elastic = evaluate<direction, false>(law, one, two);
    const double power = dot(bond.force - elastic.force, two.v - one.v) + dot(bond.torque1 - elastic.torque1, one.w) +
                         dot(bond.torque2 - elastic.torque2, two.w);
    EXPECT_LT(power, 0);
  }
}

TEST(ElasticBond, KeepsMomentumAndIsSymmetricAndObjective) {
  check_pair_laws<0>();
  check_pair_laws<1>();
}

TEST(ElasticBond, ArcTangentRatioIsExactToTheLastDigits) {
  EXPECT_EQ(arc_tangent_ratio(0), 1);
  for (int k = 1; k <= 1000; ++k) {
    const double t = k / 1000.0;
    EXPECT_NEAR(arc_tangent_ratio(t * t) * t / std::atan(t), 1, 1e-15);
  }
}

TEST(ElasticBond, MomentsAreProportionalToTheAnglesUpToAHalfTurn) {
  // Requirement: pure bending by beta gives S_nb I beta, pure torsion by psi gives S_t J psi, at any angle.
  const BondCoefficients law = bonds_of(cloth())->coefficients(0);
  for (double angle = 0.01; angle < 3.1; angle += 0.13) {
    Pose one{}, two{};
    one.q = rotation_by({0, 0, -angle / 2}), two.q = rotation_by({0, 0, angle / 2}), two.x = {law.length, 0, 0};
    BondForce bond = evaluate<0, false>(law, one, two);
    EXPECT_NEAR(bond.torque1.z / (law.bending * angle), 1, 3e-14);
    EXPECT_NEAR(bond.torque2.z / (law.bending * angle), -1, 3e-14);
    EXPECT_NEAR(std::sqrt(bond.bending_squared) / (law.bending * angle), 1, 3e-14);
    one.q = rotation_by({-angle / 2, 0, 0}), two.q = rotation_by({angle / 2, 0, 0});
    bond = evaluate<0, false>(law, one, two);
    EXPECT_NEAR(bond.torque1.x / (law.torsion * angle), 1, 3e-14);
    EXPECT_NEAR(bond.torsion_moment / (law.torsion * angle), 1, 3e-14);
  }
}

TEST(ElasticBond, AgreesWithTheIncrementalLawForModerateMotions) {
  // Requirement: Eqs. 3.10-3.20 of the thesis, integrated in 20,000 increments along one smooth motion of amplitude s, differ from the law
  // of the present pose by terms of second order in s: halving s divides the relative difference by more than 1.8.
  const BondCoefficients law = bonds_of(cloth())->coefficients(0);
  const auto difference = [&law](double s) {
    const Vec3 v1{0.1, -0.3, 0.2}, v2{0.35, 0.5, -0.4}, w1{0.3, -0.5, 0.4}, w2{-0.6, 0.7, 0.9};
    Vec3 force, moment;  // of the bond on end 2
    const int n = 20000;
    const double dt = s / n;
    Pose one{}, two{};
    two.x = {law.length, 0, 0};
    for (int k = 0; k < n; ++k) {
      const double t = (k + 0.5) * dt;
      const Vec3 r = Vec3{law.length, 0, 0} + (law.length * t) * (v2 - v1), normal = unit(r);
      const Vec3 v = law.length * (v2 - v1), w = w2 - w1, mean = 0.5 * (w1 + w2);
      // The stored vectors turn with the bond: normal by its direction, about it by the mean spin.
      const Vec3 rate = cross(normal, v) / norm(r) + dot(mean, normal) * normal;
      force += dt * cross(rate, force), moment += dt * cross(rate, moment);
      const Vec3 relative = v - cross(mean, r), tangential = relative - dot(relative, normal) * normal;
      force -= dt * (law.normal * dot(v, normal) * normal + law.shear * tangential);
      const Vec3 twist = dot(w, normal) * normal;
      moment -= dt * (law.torsion * twist + law.bending * (w - twist));
    }
    one.x = (s * law.length) * v1, two.x += (s * law.length) * v2;
    one.q = rotation_by(s * w1), two.q = rotation_by(s * w2);
    const BondForce bond = evaluate<0, false>(law, one, two);
    // What remains of torque 2 without the lever of the shear force is the moment of the bond.
    const Vec3 bond_moment = 0.5 * (bond.torque2 - bond.torque1);
    return std::pair{norm(bond.force - force) / norm(force), norm(bond_moment - moment) / norm(moment)};
  };
  const auto large = difference(0.08), small = difference(0.04);
  EXPECT_LT(small.first, 0.02);
  EXPECT_LT(small.second, 0.05);
  EXPECT_GT(large.first / small.first, 1.8);
  EXPECT_GT(large.second / small.second, 1.8);
}

}  // namespace
}  // namespace snag
