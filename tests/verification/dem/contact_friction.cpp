// Friction and rolling against exact solutions, and what every pair of particles must conserve.
#include <gtest/gtest.h>

#include <random>

#include "dem/walls/walls.hpp"
#include "tests/unit/dem/contact_pieces.hpp"

namespace snag {
namespace {

using test::Pieces;

constexpr double r = 2e-3, g = 9.81;

/// A hard sphere that lies on a horizontal plane in its own weight's overlap.
struct OnPlane {
  Pieces pieces;
  WallSet walls;
  ContactSettings settings;
  double overlap = 0;

  OnPlane(const Vec3& velocity, const Vec3& spin, const WallMotion& motion = {}) {
    const Rag rag = Pieces::sphere(r, 1150, 1e8);
    const double k = 4.0 / 3 * 1e8 / (1 - 0.25) * std::sqrt(r);  // E* = G/(1 - nu)
    overlap = std::pow(rag.mass * g / k, 2.0 / 3);
    pieces.add_sphere(rag, {0, 0, r - overlap}, velocity, spin);
    pieces.gravity = {0, 0, -g};
    walls.add_plane("floor", {}, {0, 0, 1}, motion);
    settings.wall_restitution = 0.3;
  }
  void run(ContactSolver& contacts, double time, double step = 2e-6) {
    for (int k = 0; k < static_cast<int>(time / step); ++k) pieces.advance(contacts, step);
  }
};

// A sphere thrown along a plane without spin slides at -mu g until it rolls, then keeps 5/7 of its speed, whatever the coefficient of
// friction.
TEST(ContactFriction, ThrownSphereRollsAtFiveSevenths) {
  for (const double mu : {0.2, 0.5}) {
    OnPlane set({0.1, 0, 0}, {});
    set.settings.wall_friction = mu;
    ContactSolver contacts(set.settings, set.pieces.rags, &set.walls);
    const double rolls_at = 2.0 / 7 * 0.1 / (mu * g);
    set.run(contacts, 0.5 * rolls_at);
    EXPECT_NEAR(set.pieces.get(0, Tile::vx).x / (0.1 - mu * g * 0.5 * rolls_at), 1, 1e-3);
    set.run(contacts, 1.5 * rolls_at);
    const Vec3 v = set.pieces.get(0, Tile::vx), w = set.pieces.get(0, Tile::wx);
    const double arm = r - set.overlap, moment = 2.5 * arm * arm / (r * r);  // m l^2/I: exact for the lever arm of an overlapping sphere
    EXPECT_NEAR(v.x / (0.1 * moment / (1 + moment)), 1, 1e-3);
    EXPECT_NEAR(v.x / (0.1 * 5 / 7), 1, 2e-3);
    EXPECT_NEAR(w.y * arm / v.x, 1, 1e-3);
    EXPECT_NEAR(norm(Vec3{0, v.y, 0}) + norm(Vec3{w.x, 0, w.z}) * r, 0, 1e-12);
  }
}

// On a slope a sphere sticks and rolls at 5/7 g sin(a) while tan(a) < 7/2 mu, and slides at g (sin a - mu cos a) beyond.
TEST(ContactFriction, SphereOnASlope) {
  for (const double slope : {0.3, 1.2}) {
    const double mu = 0.2;
    OnPlane set({}, {});
    set.settings.wall_friction = mu;
    set.pieces.gravity = g * Vec3{std::sin(slope), 0, -std::cos(slope)};
    ContactSolver contacts(set.settings, set.pieces.rags, &set.walls);
    set.run(contacts, 0.02);
    const double v0 = set.pieces.get(0, Tile::vx).x;
    set.run(contacts, 0.02);
    const double rolling = 5.0 / 7 * g * std::sin(slope), sliding = g * (std::sin(slope) - mu * std::cos(slope));
    EXPECT_NEAR((set.pieces.get(0, Tile::vx).x - v0) / 0.02 / (std::tan(slope) < 3.5 * mu ? rolling : sliding), 1, 3e-3) << slope;
  }
}

// Rolling friction slows a rolling sphere by 5/7 mu_r g and brings it to rest without turning it back.
TEST(ContactFriction, RollingFrictionStopsASphere) {
  OnPlane set({0.02, 0, 0}, {0, 0.02 / r, 0});
  set.settings.wall_rolling_friction = 0.02;
  ContactSolver contacts(set.settings, set.pieces.rags, &set.walls);
  set.run(contacts, 0.05);
  EXPECT_NEAR((0.02 - set.pieces.get(0, Tile::vx).x) / 0.05 / (5.0 / 7 * 0.02 * g), 1, 1e-2);
  set.run(contacts, 0.2);
  EXPECT_LT(norm(set.pieces.get(0, Tile::vx)), 1e-4);
  EXPECT_LT(norm(set.pieces.get(0, Tile::wx)) * r, 1e-4);
}

// Two particles held in contact, free to spin: rolling against each other about an axis across the contact they slow at mu_r R* F_n/I each,
// F_n = 4/3 E* sqrt(R*) d^(3/2), until they rest and do not turn back. Equal spheres roll without slip; without Coulomb friction
// nothing else acts on unequal ones. Spins about the contact's normal, and common ones, do not roll. To 1e-9: the decay is linear.
TEST(ContactFriction, RollingFrictionSlowsTwoParticles) {
  const double mu_r = 0.05, G = 1e6, nu = 0.25, overlap = 2e-5, step = 1e-6;
  for (const double r_2 : {1e-3, 2e-3}) {
    const double r_1 = 1e-3, R = r_1 * r_2 / (r_1 + r_2), E = G / (1 - nu);  // E*, R*
    const double torque = mu_r * R * 4.0 / 3 * E * std::sqrt(R) * std::pow(overlap, 1.5);
    const Vec3 n = unit({1, -2, 2}), t = unit(cross(n, {0, 0, 1}));
    const Rag first = Pieces::sphere(r_1, 540, G, nu), second = Pieces::sphere(r_2, 540, G, nu);
    const Vec3 start = 20.0 * t;
    // w_1 - w_2 falls at torque (1/I_1 + 1/I_2) until it vanishes.
    const double rests_at = 2 * norm(start) / (torque * (1 / first.inertia + 1 / second.inertia));
    const auto spins_after = [&](const Vec3& w_1, const Vec3& w_2, double time) {
      Pieces pieces;
      pieces.add_sphere(first, {}, {}, w_1), pieces.add_sphere(second, (r_1 + r_2 - overlap) * n, {}, w_2);
      ContactSettings settings;
      settings.rolling_friction = mu_r;
      if (r_1 != r_2) settings.static_friction = 0;
      ContactSolver contacts(settings, pieces.rags, nullptr);
      const auto tiles = pieces.owned();
      for (int k = 0; k < std::lround(time / step); ++k) {
        pieces.clear_forces();
        contacts.add_forces(tiles, {}, step);
        for (const int p : {0, 1})
          pieces.set(p, Tile::wx, pieces.get(p, Tile::wx) + step / pieces.rags[p].inertia * pieces.get(p, Tile::tx));
      }
      return std::array{pieces.get(0, Tile::wx), pieces.get(1, Tile::wx)};
    };
    const double half = std::lround(rests_at / 2 / step) * step;
    const auto [w_1, w_2] = spins_after(start, -start, half);
    EXPECT_LE(norm((start - w_1) / (torque * half / first.inertia) - t), 1e-9);
    EXPECT_LE(norm((-start - w_2) / (torque * half / second.inertia) + t), 1e-9);

    const auto [rest_1, rest_2] = spins_after(start, -start, 2 * rests_at);
    EXPECT_LE(norm(rest_1 - rest_2), 1e-6 * norm(start));
    const auto [drill_1, drill_2] = spins_after(20.0 * n, {}, half);
    EXPECT_LE(norm(drill_1 - 20.0 * n) + norm(drill_2), 1e-9 * norm(start));
    if (r_1 == r_2) continue;
    const auto [common_1, common_2] = spins_after(start, start, half);
    EXPECT_LE(norm(common_1 - start) + norm(common_2 - start), 1e-9 * norm(start));
  }
}

// A sphere on a conveyor belt (a translating plane) is taken along: sliding at mu g first, then rolling with 2/7 of the belt's speed.
TEST(ContactFriction, BeltTakesASphereAlong) {
  OnPlane set({}, {}, WallMotion{.axis = {0, 0, 1}, .origin = {}, .speed = 0, .velocity = {0.1, 0, 0}});
  ContactSolver contacts(set.settings, set.pieces.rags, &set.walls);
  set.run(contacts, 0.05);
  EXPECT_NEAR(set.pieces.get(0, Tile::vx).x / (0.1 * 2 / 7), 1, 2e-3);
}

// A sphere at rest on a turning disc (its plane turns about its normal) feels friction against the disc's speed there, and so does one on
// an axis off its own.
TEST(ContactFriction, TurningPlaneDragsAtItsSurfaceSpeed) {
  OnPlane set({}, {},
              WallMotion{.axis = {0, 0, 1}, .origin = {0, -0.05, 0}, .speed = -2, .velocity = {}});  // +0.1 m/s along x at the sphere
  ContactSolver contacts(set.settings, set.pieces.rags, &set.walls);
  set.run(contacts, 0.004);
  EXPECT_NEAR(set.pieces.get(0, Tile::vx).x / (0.5 * g * 0.004), 1, 1e-2);
}

// Any contact of two particles, of whatever sizes, speeds, spins and history, conserves linear and angular momentum to round-off.
TEST(ContactFriction, PairsConserveMomentum) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&](double scale) { return scale * Vec3{uniform(random), uniform(random), uniform(random)}; };
  for (int k = 0; k < 200; ++k) {
    Pieces pieces;
    const double r1 = 1e-3, r2 = (1.5 + uniform(random)) * 1e-3;
    const Vec3 x = vector(0.01), n = unit(vector(1));
    pieces.add_sphere(Pieces::sphere(r1, 540), x, vector(1), vector(500));
    pieces.add_sphere(Pieces::sphere(r2, 1100), x + 0.93 * (r1 + r2) * n, vector(1), vector(500));
    ContactSettings settings;
    settings.rolling_friction = 0.1;
    ContactSolver contacts(settings, pieces.rags, nullptr);
    const auto tiles = pieces.owned();
    for (int step = 0; step < 3; ++step) {
      pieces.clear_forces();
      contacts.add_forces(tiles, {}, 1e-6);
    }
    const Vec3 f1 = pieces.get(0, Tile::fx), f2 = pieces.get(1, Tile::fx);
    ASSERT_GT(norm(f1), 0);
    EXPECT_LE(norm(f1 + f2), 1e-14 * norm(f1));
    const Vec3 x1 = pieces.get(0, Tile::x), x2 = pieces.get(1, Tile::x), t1 = pieces.get(0, Tile::tx), t2 = pieces.get(1, Tile::tx);
    EXPECT_LE(norm(cross(x1 - x2, f1) + t1 + t2), 1e-14 * (norm(x1 - x2) * norm(f1) + norm(t1) + norm(t2)));
  }
}

// The force does not depend on who is first: exchanging the two particles exchanges the forces to round-off.
TEST(ContactFriction, PairsAreSymmetric) {
  Vec3 force[2], torque[2];
  for (int order = 0; order < 2; ++order) {
    Pieces pieces;
    for (int i = 0; i < 2; ++i) {
      if (i == order)
        pieces.add_sphere(Pieces::sphere(1e-3, 540), {}, {0.3, 0.1, -0.2}, {100, 20, -70});
      else
        pieces.add_sphere(Pieces::sphere(2e-3, 900), {1e-3, 2e-3, 1.8e-3}, {-0.3, 0.5, 0.1}, {10, -220, 30});
    }
    ContactSolver contacts(ContactSettings{}, pieces.rags, nullptr);
    const auto tiles = pieces.owned();
    contacts.add_forces(tiles, {}, 1e-6);
    force[order] = pieces.get(order, Tile::fx), torque[order] = pieces.get(order, Tile::tx);
  }
  EXPECT_GT(norm(force[0]), 0);
  EXPECT_LE(norm(force[0] - force[1]), 1e-14 * norm(force[0]));
  EXPECT_LE(norm(torque[0] - torque[1]), 1e-14 * norm(torque[0]));
}

// Two spheres that stick to each other and turn together as one body keep their tangential spring: its force turns with them without change
// of size.
TEST(ContactFriction, SlipTurnsWithThePair) {
  Pieces pieces;
  const Rag rag = Pieces::sphere(1e-3, 540);
  pieces.add_sphere(rag, {}), pieces.add_sphere(rag, {1.9e-3, 0, 0});
  ContactSettings settings;
  settings.static_friction = 10;
  ContactSolver contacts(settings, pieces.rags, nullptr);
  const auto tiles = pieces.owned();
  // Shear by hand, then turn the pair rigidly in small steps about z and force it again.
  pieces.set(1, Tile::vx, {0, 0.1, 0.05});
  for (int k = 0; k < 100; ++k) contacts.add_forces(tiles, {}, 1e-6);
  const int n = 2000;
  const double angle = 1.1, spin = 1.0;
  const Vec3 w{0, 0, spin};
  Vec3 start, now;
  for (int k = 0; k <= n; ++k) {
    const double c = std::cos(angle * k / n), s = std::sin(angle * k / n);
    pieces.set(1, Tile::x, 1.9e-3 * Vec3{c, s, 0});
    pieces.set(1, Tile::vx, cross(w, 1.9e-3 * Vec3{c, s, 0}));
    pieces.set(0, Tile::wx, w), pieces.set(1, Tile::wx, w);
    pieces.clear_forces();
    contacts.add_forces(tiles, {}, angle / n / spin);
    now = pieces.get(1, Tile::fx);
    if (k == 0) start = now;
  }
  const double c = std::cos(angle), s = std::sin(angle);
  const Vec3 turned{c * start.x - s * start.y, s * start.x + c * start.y, start.z};
  EXPECT_GT(std::abs(start.y), 0.1 * std::abs(start.x));
  EXPECT_NEAR(norm(now) / norm(start), 1, 1e-9);
  // Slip is projected and stretched, not turned: its two components mix by half the square of the angle of a step, here 2000 times
  // (5.5e-4)^2/2.
  EXPECT_LE(norm(now - turned), 3e-4 * norm(start));
}

}  // namespace
}  // namespace snag
