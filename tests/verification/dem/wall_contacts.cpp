// Contacts with walls of triangles against single planes and exact equilibria.
#include <gtest/gtest.h>

#include <random>

#include "dem/contacts/contact_pair.hpp"
#include "dem/walls/walls.hpp"
#include "tests/unit/dem/contact_pieces.hpp"
#include "tests/unit/dem/wall_pieces.hpp"

namespace snag {
namespace {

using test::Pieces;

constexpr double r = 2e-3;
const Rag sphere = Pieces::sphere(r, 1150);

/// Force and torque on a sphere that is led along a path (position and velocity by hand).
struct Led {
  Pieces pieces;
  ContactSolver contacts;
  explicit Led(const WallSet& walls, const ContactSettings& settings = {})
      : pieces(with_sphere()), contacts(settings, pieces.rags, &walls) {}
  static Pieces with_sphere() {
    Pieces p;
    p.add_sphere(sphere, {});
    return p;
  }
  void at(const Vec3& x, const Vec3& v, const Vec3& w, double step) {
    pieces.set(0, Tile::x, x), pieces.set(0, Tile::vx, v), pieces.set(0, Tile::wx, w);
    pieces.clear_forces();
    const auto tiles = pieces.owned();
    contacts.add_forces(tiles, {}, step);
  }
  Vec3 force() const { return pieces.get(0, Tile::fx); }
  Vec3 torque() const { return pieces.get(0, Tile::tx); }
};

/// F = 4/3 E* sqrt(r) d^(3/2), of two bodies of the same material E* = G/(1 - nu).
double hertz_force(double overlap) {
  return 4.0 / 3 * sphere.shear_modulus / (1 - sphere.poisson_ratio) * std::sqrt(r) * std::pow(overlap, 1.5);
}

/// A flat floor of uneven triangles, some smaller and some larger than the sphere.
WallSurface uneven_floor() {
  return test::sheet(12, 12, [](double u, double v) {
    const auto stretched = [](double s) { return 0.02 * (s + 0.6 * s * (1 - s) * (2 * s - 1)); };
    return Vec3{stretched(u) + 1e-4 * std::sin(40 * v), stretched(v) + 1e-4 * std::sin(50 * u), 0};
  });
}

// A sphere that slides and rolls over the edges and corners of a triangulated plane feels what it feels on the single plane, history
// included.
TEST(WallContacts, TriangulatedPlaneIsAPlane) {
  WallSet triangles, plane;
  triangles.add_surface("floor", uneven_floor());
  plane.add_plane("floor", {}, {0, 0, 1});
  Led on_triangles(triangles), on_plane(plane);
  const double step = 1e-5;
  double largest = 0, worst_force = 0, worst_torque = 0, friction = 0;
  for (int k = 0; k < 4000; ++k) {
    const double s = k / 4000.0;
    const Vec3 x{0.002 + 0.016 * s, 0.003 + 0.013 * s + 1e-3 * std::sin(9 * s), r - 0.2e-3 * (1 + 0.3 * std::sin(20 * s))};
    const Vec3 v{0.4 * std::cos(3 * s), 0.3, 0.01}, w{-150 * s, 120, 30};
    on_triangles.at(x, v, w, step), on_plane.at(x, v, w, step);
    largest = std::max(largest, norm(on_plane.force()));
    worst_force = std::max(worst_force, norm(on_triangles.force() - on_plane.force()));
    worst_torque = std::max(worst_torque, norm(on_triangles.torque() - on_plane.torque()));
    const Vec3 f = on_plane.force();
    friction = std::max(friction, norm(Vec3{f.x, f.y, 0}));
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_GT(friction, 0.1 * largest);
  EXPECT_LE(worst_force, 1e-12 * largest);
  EXPECT_LE(worst_torque, 1e-12 * largest * r);
}

// The same with the sphere's centre exactly above nodes, edges and points very near them.
TEST(WallContacts, NodesAndEdgesAreNotCountedTwice) {
  WallSet triangles;
  const WallSurface surface = uneven_floor();
  triangles.add_surface("floor", surface);
  Led led(triangles);
  for (const WallTriangle& t : surface.triangles)
    for (const Vec3& foot : {t.node[0], 0.5 * (t.node[0] + t.node[1]), 0.3 * t.node[1] + 0.7 * t.node[2], t.node[2] + Vec3{1e-15, 0, 0}}) {
      if (foot.x < r || foot.y < r || foot.x > 0.02 - r || foot.y > 0.02 - r) continue;
      led.at(foot + Vec3{0, 0, 0.8 * r}, {}, {}, 0);
      EXPECT_NEAR(led.force().z / hertz_force(0.2 * r), 1, 1e-11);
      EXPECT_LE(std::abs(led.force().x) + std::abs(led.force().y), 1e-11 * led.force().z);
      EXPECT_EQ(led.contacts.measures().n_wall_contacts, 1);
    }
}

// Round a convex edge of a solid the force points away from the nearest point of the solid, without a jump from face to edge to face.
TEST(WallContacts, ConvexEdgeAndCorner) {
  WallSet walls;
  const Vec3 upper{0.01, 0.01, 0.01};
  walls.add_surface("block", test::solid_box({}, upper));
  Led led(walls);
  const double d = 0.8 * r;
  for (int k = 0; k <= 90; ++k) {  // about the edge x = y = 0.01
    const double angle = k * std::numbers::pi / 180;
    const Vec3 e{std::sin(angle), std::cos(angle), 0};
    led.at(Vec3{0.01, 0.01, 0.004} + d * e, {}, {}, 0);
    EXPECT_LE(norm(led.force() - hertz_force(r - d) * e), 1e-10 * hertz_force(r - d)) << k;
    EXPECT_EQ(led.contacts.measures().n_wall_contacts, 1);
  }
  const Vec3 e = unit(Vec3{1, 2, 0.7});
  led.at(upper + d * e, {}, {}, 0);
  EXPECT_LE(norm(led.force() - hertz_force(r - d) * e), 1e-10 * hertz_force(r - d));
  led.at(Vec3{0.004, 0.01 + d, 0.003}, {}, {}, 0);
  EXPECT_LE(norm(led.force() - hertz_force(r - d) * Vec3{0, 1, 0}), 1e-10 * hertz_force(r - d));
}

// In a concave corner of 90 degrees both walls act: a sphere comes to rest where each carries its part of the weight; in a box, three do.
TEST(WallContacts, ConcaveCornerHoldsASphere) {
  for (const bool box : {false, true}) {
    WallSet walls;
    if (box) {
      walls.add_box("box", {}, {0.02, 0.02, 0.02});
    } else {  // floor y = 0 and wall x = 0 as one surface with a common edge
      walls.add_surface("corner", test::sheet(8, 8, [](double u, double v) {
                          return u < 0.5 ? Vec3{0, 0.02 * (1 - 2 * u), 0.02 * (1 - v)} : Vec3{0.02 * (2 * u - 1), 0, 0.02 * (1 - v)};
                        }));
    }
    Pieces pieces;
    pieces.add_sphere(sphere, {1.1 * r, 1.2 * r, 0.0083});
    const double a = 0.6;
    pieces.gravity = -9.81 * Vec3{std::sin(a), std::cos(a), 0};
    ContactSettings settings;
    settings.wall_friction = 0;
    settings.wall_restitution = 0.1;
    ContactSolver contacts(settings, pieces.rags, &walls);
    for (int k = 0; k < 20000; ++k) pieces.advance(contacts, 2e-5);
    EXPECT_EQ(contacts.measures().n_wall_contacts, 2);
    const Vec3 x = pieces.get(0, Tile::x);
    EXPECT_NEAR(hertz_force(r - x.x) / (sphere.mass * 9.81 * std::sin(a)), 1, 1e-6);
    EXPECT_NEAR(hertz_force(r - x.y) / (sphere.mass * 9.81 * std::cos(a)), 1, 1e-6);
  }
}

/// A drum about z with `n` facets of radius R (to the middle of a facet), the fluid inside.
WallSurface drum(int n, double R) {
  const double corner = R / std::cos(std::numbers::pi / n);
  return test::sheet(
      n, 4,
      [&](double u, double v) {
        const double angle = 2 * std::numbers::pi * u;
        return Vec3{corner * std::cos(angle), corner * std::sin(angle), 0.02 * (0.5 - v)};
      },
      true);
}

// In a turning drum a sphere that turns with it is pressed on by m Omega^2 (R - r), stays where it is in the drum, and friction does no
// work.
TEST(WallContacts, SphereTurnsWithADrum) {
  const double R = 0.02, speed = 60;
  WallSet walls;
  walls.add_surface("drum", drum(40, R), WallMotion{.axis = {0, 0, 2}, .origin = {}, .speed = speed, .velocity = {}});
  Pieces pieces;
  const Vec3 w{0, 0, speed}, x0{R - r, 0, 0.001};
  pieces.add_sphere(sphere, x0, cross(w, x0), w);
  ContactSolver contacts(ContactSettings{}, pieces.rags, &walls);
  const double step = 2e-5;
  const int steps = static_cast<int>(std::lround(2 * std::numbers::pi / speed / step));
  double push = 0;  // normal force of the drum, summed over the last two turns, N
  for (int k = 1; k <= 5 * steps; ++k) {
    contacts.set_time(k * step);
    pieces.advance(contacts, step);
    if (k <= 3 * steps) continue;
    const Vec3 x = pieces.get(0, Tile::x);
    push -= dot(contacts.forces(std::span<const Tile>(pieces.owned()[0], 1)).at(0), unit(Vec3{x.x, x.y, 0}));
  }
  const double t = 5 * steps * step;
  const double mean_push = push / (2 * steps);
  const Vec3 x = pieces.get(0, Tile::x), in_drum = wall_pose(walls.bodies()[0].motion, t).in_wall(x);
  EXPECT_NEAR(mean_push / (sphere.mass * speed * speed * norm(Vec3{x.x, x.y, 0})), 1, 1e-3);
  EXPECT_NEAR(std::atan2(in_drum.y, in_drum.x), std::atan2(x0.y, x0.x), 0.02);  // the facet's half width is 0.08
  EXPECT_NEAR(pieces.get(0, Tile::wx).z / speed, 1, 1e-2);
  EXPECT_NEAR(norm(pieces.get(0, Tile::vx)) / (speed * norm(Vec3{x.x, x.y, 0})), 1, 1e-2);
  EXPECT_EQ(contacts.measures().beyond_walls[0], 0);
}

// Under gravity a sphere in a slowly turning drum of many facets rolls at the bottom: its surface keeps up with the drum's.
TEST(WallContacts, SphereRollsInADrum) {
  const double R = 0.02, speed = 3;
  WallSet walls;
  walls.add_surface("drum", drum(240, R), WallMotion{.axis = {0, 0, 1}, .origin = {}, .speed = speed, .velocity = {}});
  Pieces pieces;
  pieces.add_sphere(sphere, {0, -(R - r), 0.001}, {}, {0, 0, 0.5 * speed * R / r});
  pieces.gravity = {0, -9.81, 0};
  ContactSettings settings;
  settings.wall_restitution = 0.3;
  ContactSolver contacts(settings, pieces.rags, &walls);
  double spin = 0;
  for (int k = 0; k < 120000; ++k) {
    pieces.advance(contacts, 2e-5);
    if (k >= 20000) spin += pieces.get(0, Tile::wx).z / 100000;
  }
  EXPECT_NEAR(spin * r / (speed * R), 1, 0.02);
  EXPECT_LT(norm(pieces.get(0, Tile::x) - Vec3{0, -(R - r), 0.001}), 0.1 * R);
}

// A wall that turns is the same as particles that turn the other way past a wall at rest: forces agree in the turning frame (no gravity, no
// history).
TEST(WallContacts, TurningWallIsARelativeMotion) {
  const WallMotion motion{.axis = {1, 2, -1}, .origin = {0.001, 0.002, -0.003}, .speed = 170, .velocity = {1, -2, 0.5}};
  WallSet turning, still;
  turning.add_surface("block", test::solid_box({}, {0.01, 0.01, 0.01}), motion);
  still.add_surface("block", test::solid_box({}, {0.01, 0.01, 0.01}));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&](double scale) { return scale * Vec3{uniform(random), uniform(random), uniform(random)}; };
  int touching = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 X = Vec3{0.005, 0.005, 0.005} + vector(0.0065), V = vector(3), W = vector(300);
    Led at_rest(still), in_turn(turning);
    at_rest.at(X, V, W, 1e-6);
    const double time = 0.0123 * k;
    const WallPose pose = wall_pose(motion, time);
    const Vec3 x = pose.in_space(X);
    in_turn.contacts.set_time(time);
    in_turn.at(x, pose.turned(V) + pose.velocity_at(x), pose.turned(W) + pose.spin, 1e-6);
    touching += norm(at_rest.force()) > 0;
    EXPECT_LE(norm(in_turn.force() - pose.turned(at_rest.force())), 1e-8 * norm(at_rest.force()));
    EXPECT_LE(norm(in_turn.torque() - pose.turned(at_rest.torque())), 1e-8 * norm(at_rest.force()) * r);
  }
  EXPECT_GT(touching, 50);
}

// Two walls that are flush without common nodes (rotor and casing at the seam) are one wall.
TEST(WallContacts, FlushWallsAreOneWall) {
  WallSet walls, plane;
  walls.add_surface("casing", test::sheet(5, 5, [](double u, double v) { return Vec3{0.01 * (u - 1), 0.02 * v, 0}; }));
  walls.add_surface("rotor",
                    test::sheet(7, 3,
                                [](double u, double v) {
                                  return Vec3{0.01 * u, 0.02 * v, 0};
                                }),
                    WallMotion{.axis = {0, 0, 1}, .origin = {0, 0.01, 0}, .speed = 0, .velocity = {}});
  plane.add_plane("floor", {}, {0, 0, 1});
  Led on_seam(walls), on_plane(plane);
  for (int k = -20; k <= 20; ++k) {
    const double x = 0.05 * k * r;
    on_seam.at({x, 0.0113, 0.95 * r}, {}, {}, 0), on_plane.at({x, 0.0113, 0.95 * r}, {}, {}, 0);
    EXPECT_LE(norm(on_seam.force() - on_plane.force()), 1e-12 * norm(on_plane.force())) << x;
  }
}

// A plate thinner than the sphere: its back does nothing to a sphere in front, and a sphere whose centre is in it goes back the nearer way.
TEST(WallContacts, ThinPlate) {
  WallSet walls;
  walls.add_surface("plate", test::solid_box({0, 0, 0}, {0.02, 0.02, 0.4 * r}));
  Led led(walls);
  led.at({0.009, 0.01, 1.3 * r}, {}, {}, 0);
  EXPECT_NEAR(led.force().z / hertz_force(0.1 * r), 1, 1e-10);
  EXPECT_EQ(led.contacts.measures().beyond_walls[0], 0);
  led.at({0.009, 0.01, 0.3 * r}, {}, {}, 0);
  EXPECT_NEAR(led.force().z / hertz_force(1.1 * r), 1, 1e-10);
  EXPECT_EQ(led.contacts.measures().beyond_walls[0], 1);
  led.at({0.009, 0.01, 0.1 * r}, {}, {}, 0);
  EXPECT_NEAR(led.force().z / hertz_force(1.1 * r), -1, 1e-10);
}

}  // namespace
}  // namespace snag
