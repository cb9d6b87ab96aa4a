// ranks: 1 3
// Cloth that lies on cloth: its own friction and thickness, whatever the directions and the spacings of the two lattices.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "dem/contacts/contact_solver.hpp"
#include "dem/rag_measures.hpp"
#include "dem/walls/walls.hpp"
#include "parallel/session.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

using namespace testing_pieces;

constexpr double g = 9.81, mu = 0.3, deg = std::numbers::pi / 180;

RagPiece damped(int n_columns, int n_rows, double radius, const Vec3& centre, double turn) {
  RagPiece piece = cloth(n_columns, n_rows);
  Rag& rag = piece.rag;
  const double scale = radius / rag.radius;
  rag.radius = radius, rag.mass *= scale * scale, rag.inertia = 0.4 * rag.mass * radius * radius;
  rag.bond = {published_bond(radius, 0), published_bond(radius, 1)};
  rag.bond_damping = 0.5, rag.cloth_friction = mu;
  piece.centre = centre, piece.orientation = rotation_to({std::cos(turn), std::sin(turn), 0}, {-std::sin(turn), std::cos(turn), 0});
  return piece;
}

/// A piece on a held one, under gravity at an angle to it.
struct Slope {
  Slope(double angle, double turn, double radius, double side)
      : rags(MPI_COMM_WORLD, {}, {damped(40, 15, 1e-3, {}, 0), damped(10, 7, radius, {-0.02, 0, 1e-3 + radius - 1e-6}, turn)}) {
    rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), nullptr));
    rags.clamp([](std::int64_t id) { return id < 600; });
    rags.set_gravity({g * std::sin(angle) * std::cos(side), g * std::sin(angle) * std::sin(side), -g * std::cos(angle)});
  }
  Vec3 velocity() const { return rag_states(rags)[1].velocity; }
  RagSystem rags;
};

TEST(ClothOnCloth, SlidesByItsFriction) {
  // Requirement: a piece rests below the angle of friction and slides at g (sin - mu cos) above it, within 1 %; before, the particles of
  // one cloth caught in the hollows of the other: at mu = 0.3 it rested at 29 degrees, and slid as with 0.44 to 0.80.
  struct Lattice {
    double radius, turn;  // of the piece that lies on the other, m, rad
  };
  for (const auto [radius, turn] : {Lattice{1e-3, 0}, Lattice{1e-3, 45 * deg}, Lattice{1.5e-3, 17 * deg}}) {
    Slope rests(15 * deg, turn, radius, 0.1);
    for (int k = 0; k < 6; ++k) rests.rags.advance(5e-3);
    Slope slides(35 * deg, turn, radius, 0.1);
    for (int k = 0; k < 2; ++k) slides.rags.advance(5e-3);
    const double start = norm(slides.velocity());
    for (int k = 0; k < 6; ++k) slides.rags.advance(5e-3);
    const double acceleration = (norm(slides.velocity()) - start) / 0.03;
    const double felt = (std::sin(35 * deg) - acceleration / g) / std::cos(35 * deg), rest = norm(rests.velocity());
    if (rank_of(MPI_COMM_WORLD) == 0)
      std::printf("r = %.1f mm on 1 mm, turned by %.0f degrees: coefficient %.4f; at 15 degrees %.1g m/s\n", 1e3 * radius, turn / deg, felt,
                  rest);
    EXPECT_NEAR(felt, mu, 0.01 * mu);
    EXPECT_LT(rest, 1e-6);
  }
}

TEST(ClothOnCloth, LayersLieTheirThicknessApart) {
  // Requirement: layers shifted and turned at will lie layer_thickness above each other, within 1 % of it, also where they are thinner than
  // the gaps of the lattice; before, they lay in each other's hollows or fell through them. Under a weight that presses them in by less.
  constexpr std::size_t n_side = 10;
  for (const double thickness : {2e-3, 0.8e-3}) {
    std::vector<RagPiece> layers;
    for (int l = 0; l < 5; ++l) {
      layers.push_back(damped(n_side, n_side, 1e-3, {0.6e-3 * l, -0.35e-3 * l * l, thickness * (l + 0.5)}, 11 * deg * l));
      layers.back().rag.layer_thickness = layers.back().rag.contact_thickness = thickness;
    }
    WallSet floor;
    floor.add_plane("floor", {}, {0, 0, 1});
    RagSystem rags(MPI_COMM_WORLD, {}, layers);
    rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), &floor));
    rags.set_gravity({0, 0, -1});
    for (int k = 0; k < 10; ++k) rags.advance(5e-3);
    const RagSheet sheet = gather_sheet(rags);
    if (rank_of(MPI_COMM_WORLD) != 0) continue;
    for (std::size_t l = 0; l < 5; ++l) {
      const double height = sheet.position[l * n_side * n_side + n_side * n_side / 2 + n_side / 2].z,
                   expected = thickness * (static_cast<double>(l) + 0.5);
      std::printf("layer %d of %.1f mm at %.4f mm\n", static_cast<int>(l), 1e3 * thickness, 1e3 * height);
      EXPECT_NEAR(height, expected, 0.01 * thickness);
    }
  }
}

TEST(ClothOnCloth, KeepsMomentum) {
  // Requirement: two pieces that hit each other at an angle, edges and all, keep linear and angular momentum to round-off.
  RagPiece one = damped(12, 9, 1e-3, {}, 0), two = damped(9, 14, 1.5e-3, {2e-3, 1e-3, 10e-3}, 0.3);
  two.orientation = rotation_to({1, 0.2, 0.5}, {0, 1, -0.1});
  one.velocity = {0.1, 0, 0.5}, two.velocity = {-0.2, 0.1, -1}, two.spin = {10, -20, 5};
  RagSystem rags(MPI_COMM_WORLD, {}, {one, two});
  rags.set_contacts(std::make_unique<ContactSolver>(ContactSettings{}, rags.rags(), nullptr));
  const auto momenta = [&rags] {
    const std::vector<RagState> states = rag_states(rags);
    return std::array{states[0].momentum + states[1].momentum, states[0].angular_momentum + states[1].angular_momentum};
  };
  const auto before = momenta();
  std::int64_t most = 0;
  for (int k = 0; k < 20; ++k) rags.advance(5e-4), most = std::max(most, rags.contacts()->measures().n_contacts);
  const auto after = momenta();
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  std::printf("up to %d contacts on rank 0; momentum changes by %.1e, angular momentum by %.1e of their scales\n", static_cast<int>(most),
              norm(after[0] - before[0]) / (108 * one.rag.mass), norm(after[1] - before[1]) / (108 * one.rag.mass * 0.01));
  EXPECT_LT(norm(after[0] - before[0]), 1e-12 * 108 * one.rag.mass);
  EXPECT_LT(norm(after[1] - before[1]), 1e-12 * 108 * one.rag.mass * 0.01);
}

}  // namespace
}  // namespace snag
