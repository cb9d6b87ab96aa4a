// Impacts against exact solutions: after Chung and Ooi (2011), benchmarks 1, 2, 3 (normal impact, elastic and damped) and 5, 6 (oblique
// impact).
#include <gtest/gtest.h>

#include <numbers>

#include "tests/verification/dem/impact.hpp"

namespace snag {
namespace {

using namespace testing_impact;

/// Head-on impact of two spheres of different size at 2 m/s.
Impact head_on(double restitution, double steps_per_impact) {
  Pieces pieces;
  pieces.add_sphere(Pieces::sphere(1e-3, 540), {0, 0, 0}, {1.5, 0, 0});
  pieces.add_sphere(Pieces::sphere(1.5e-3, 900), {2.5005e-3, 0, 0}, {-0.5, 0, 0});
  ContactSolver contacts(settings_of(restitution, 0), pieces.rags, nullptr);
  const ContactPair pair = particle_pair(pieces.rags[0], pieces.rags[1], settings_of(restitution, 0));
  Impact impact = run_impact(pieces, contacts, pair.law->impact_time(2) / steps_per_impact,
                             [&] { return 2.5e-3 - norm(pieces.get(1, Tile::x) - pieces.get(0, Tile::x)); });
  impact.speed_after = pieces.get(1, Tile::vx).x - pieces.get(0, Tile::vx).x;
  return impact;
}

// Two elastic spheres part after the Hertz time with the deepest overlap of the exact solution and the speed they met with.
TEST(ContactImpact, ElasticSpheresFollowHertz) {
  const Impact impact = head_on(1, 1000);
  const Rag a = Pieces::sphere(1e-3, 540), b = Pieces::sphere(1.5e-3, 900);
  const ContactPair pair = particle_pair(a, b, settings_of(1, 0));
  EXPECT_NEAR(impact.duration / pair.law->impact_time(2), 1, 1e-4);
  EXPECT_NEAR(impact.deepest / pair.law->deepest_overlap(2), 1, 1e-5);
  EXPECT_NEAR(impact.speed_after / 2, 1, 1e-5);
  // The formulas themselves: 1/2 m* u^2 is the work 8/15 E* sqrt(R*) d^(5/2) up to the deepest overlap.
  const double m = a.mass * b.mass / (a.mass + b.mass), E = 1e6 / (1 - 0.25), R = 0.6e-3;  // E* of two bodies of G, nu: G/(1 - nu)
  EXPECT_NEAR(8.0 / 15 * E * std::sqrt(R) * std::pow(pair.law->deepest_overlap(2), 2.5) / (0.5 * m * 4), 1, 1e-12);
}

// The speed after an impact converges to the exact one: elastic with second order in the step; damped with first order, because velocities
// lag half a step.
TEST(ContactImpact, SpeedAfterConverges) {
  const auto error = [](double e, double steps) { return std::abs(head_on(e, steps).speed_after / 2 - e); };
  EXPECT_GT(std::log2(error(1, 25) / error(1, 200)) / 3, 1.8);
  EXPECT_GT(std::log2(error(0.5, 1600) / error(0.5, 25600)) / 4, 0.85);
}

// A damped impact gives back the coefficient of restitution for all speeds; the law needs the pull at its end for that.
TEST(ContactImpact, RestitutionIsReproduced) {
  for (const double e : {0.2, 0.6, 0.9}) EXPECT_NEAR(head_on(e, 4000).speed_after / 2, e, 2e-3 * (1 + e)) << "e = " << e;
  EXPECT_NEAR(head_on(0.01, 20000).speed_after / 2, 0.01, 2e-3);
}

// A linear spring and dashpot gives back e exactly, after half a period of the damped oscillator, with the deepest overlap of its formula.
TEST(ContactImpact, LinearSpringIsADampedOscillator) {
  const Rag sphere = Pieces::sphere(1e-3, 1150);
  for (const double e : {1.0, 0.8, 0.3}) {
    Pieces pieces;
    pieces.add_sphere(sphere, {}, {0.5, 0, 0});
    pieces.add_sphere(sphere, {2.0001e-3, 0, 0}, {-0.5, 0, 0});
    ContactSettings settings = settings_of(e, 0);
    settings.law_name = "linear_spring";
    ContactSolver contacts(settings, pieces.rags, nullptr);
    const double E = sphere.shear_modulus / (1 - sphere.poisson_ratio), m = sphere.mass / 2, omega = std::sqrt(0.4 * E * 0.5e-3 / m);
    const double B = damping_of_restitution(e), damped = omega * std::sqrt(1 - B * B);
    const Impact impact = run_impact(pieces, contacts, std::numbers::pi / omega / 20000,
                                     [&] { return 2e-3 - norm(pieces.get(1, Tile::x) - pieces.get(0, Tile::x)); });
    EXPECT_NEAR(pieces.get(1, Tile::vx).x - pieces.get(0, Tile::vx).x, e, 1e-3) << e;
    EXPECT_NEAR(impact.duration * damped / std::numbers::pi, 1, 1e-3) << e;
    EXPECT_NEAR(impact.deepest * omega, std::exp(-B / std::sqrt(1 - B * B) * std::acos(B)), 1e-3) << e;
  }
}

// A sphere meets an elastic plane as it meets a sphere of infinite radius.
TEST(ContactImpact, ElasticPlaneFollowsHertz) {
  Pieces pieces;
  const Rag rag = Pieces::sphere(2e-3, 1150);
  pieces.add_sphere(rag, {0, 0, 2.01e-3}, {0, 0, -1});
  WallSet walls;
  walls.add_plane("floor", {}, {0, 0, 3});
  ContactSettings s = settings_of(1, 0.3);
  s.wall_stiffness_factor = 4;
  ContactSolver contacts(s, pieces.rags, &walls);
  const ContactPair pair = wall_pair(rag, s);
  const Impact impact = run_impact(pieces, contacts, pair.law->impact_time(1) / 1000, [&] { return 2e-3 - pieces.get(0, Tile::x).z; });
  const double k = 16.0 / 15 * 4 * 1e6 / (1 - 0.25) * std::sqrt(2e-3);
  EXPECT_NEAR(impact.duration / (2.943175 * std::pow(rag.mass * rag.mass / (k * k), 0.2)), 1, 1e-4);
  EXPECT_NEAR(impact.deepest / std::pow(rag.mass / k, 0.4), 1, 1e-5);
  EXPECT_NEAR(impact.velocity.z, 1, 1e-5);
}

/// Oblique impact on a plane at 3 m/s, `angle` from the normal.
Impact oblique(double angle, double e, double mu, double poisson_ratio) {
  Pieces pieces;
  const Rag rag = Pieces::sphere(2e-3, 1150, 1e10, poisson_ratio);
  pieces.add_sphere(rag, {0, 0, 2.0001e-3}, {3 * std::sin(angle), 0, -3 * std::cos(angle)});
  WallSet walls;
  walls.add_plane("floor", {}, {0, 0, 1});
  ContactSolver contacts(settings_of(e, mu), pieces.rags, &walls);
  const double step = wall_pair(rag, settings_of(e, mu)).law->impact_time(3 * std::cos(angle)) / 4000;
  return run_impact(pieces, contacts, step, [&] { return 2e-3 - pieces.get(0, Tile::x).z; });
}

// An impact that slides throughout has the rigid-body tangential restitution 1 - mu (1 + e)/tan(angle) and spin 5/2 mu (1 + e) u_n/r.
TEST(ContactImpact, SlidingObliqueImpactIsThatOfRigidBodies) {
  for (const double degrees : {50.0, 65.0, 80.0}) {
    const double angle = degrees * std::numbers::pi / 180, mu = 0.1, e = 1;
    const Impact impact = oblique(angle, e, mu, 0.25);
    const double u_n = 3 * std::cos(angle), u_t = 3 * std::sin(angle);
    EXPECT_NEAR(impact.velocity.x / u_t, 1 - mu * (1 + e) / std::tan(angle), 1e-4) << degrees;
    // The arm of friction is r less the overlap: spin is lower by some of overlap/r, here under 0.5 %.
    EXPECT_NEAR(impact.spin.y / (2.5 * mu * (1 + e) * u_n / 2e-3), 1, 0.005) << degrees;
  }
}

// Damped, the same holds up to the pull at the end of the impact, which friction does not see: friction then is larger by less than that
// part.
TEST(ContactImpact, DampedSlidingImpactIsNearThatOfRigidBodies) {
  const double angle = 70 * std::numbers::pi / 180, mu = 0.1;
  for (const double e : {0.98, 0.7})
    EXPECT_NEAR(oblique(angle, e, mu, 0.25).velocity.x / (3 * std::sin(angle)), 1 - mu * (1 + e) / std::tan(angle), 4e-3) << e;
}

// Between sticking and sliding the recoil of the tangential spring throws the surface of the sphere back (Maw, Barber and Fawcett 1976).
TEST(ContactImpact, ModerateObliqueImpactRecoils) {
  const double nu = 0.25, mu = 0.5;
  const double angle = std::atan(2 * mu * (2 - nu) / (2 * (1 - nu)));  // their non-dimensional angle of incidence psi_1 = 2
  const Impact impact = oblique(angle, 1, mu, nu);
  EXPECT_LT(impact.velocity.x - 2e-3 * impact.spin.y, -0.1 * 3 * std::sin(angle));
}

// Shrinking the step inside the stable range leaves the outcome of a wet, nearly plastic impact: the step bound keeps the damped springs
// stable.
TEST(ContactImpact, StableStepIsStable) {
  Pieces pieces;
  const Rag rag = Pieces::sphere(1e-3, 540);
  pieces.add_sphere(rag, {0, 0, 1.001e-3}, {4, 0, -3});  // 5 m/s, the default impact_speed
  WallSet walls;
  walls.add_plane("floor", {}, {0, 0, 1});
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  const double step = contacts.stable_step();
  const double energy_before = 0.5 * rag.mass * 25;
  for (int k = 0; k < 4000; ++k) {
    pieces.advance(contacts, step);
    const double energy =
        0.5 * rag.mass * norm_squared(pieces.get(0, Tile::vx)) + 0.5 * rag.inertia * norm_squared(pieces.get(0, Tile::wx));
    ASSERT_LE(energy, energy_before * (1 + 1e-12));
  }
  EXPECT_LT(std::abs(pieces.get(0, Tile::vx).z), 0.1);
}

}  // namespace
}  // namespace snag
