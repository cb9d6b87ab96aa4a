// Adhesion of particles and cloth to walls: pull-off force, weight that it carries, friction that it adds.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "dem/contacts/contact_solver.hpp"
#include "dem/contacts/pair_forces.hpp"
#include "dem/contacts/wall_loads.hpp"
#include "dem/rag_measures.hpp"
#include "dem/walls/walls.hpp"
#include "tests/unit/dem/contact_pieces.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

constexpr double w = 0.05;  // J/m2, the default of the law with walls

ContactSettings adhesive() {
  ContactSettings settings;
  settings.law_name = "hertz_dmt";
  return settings;
}

TEST(Adhesion, ParticleComesOffAtThePullOffForce) {
  // Requirement: a particle that is pulled off a wall by a force that grows slowly parts at F_a = 2 pi w r, to 0.1 %, and rests under half
  // of it at the overlap (F_a/2/k)^(2/3).
  const double r = 1e-3, step = 2e-6;  // m, s
  test::Pieces pieces;
  const Rag rag = test::Pieces::sphere(r, 540);
  const double F_a = 2 * std::numbers::pi * w * r, k = 4.0 / 3 * 1e6 / (1 - 0.25) * std::sqrt(r);  // E* = G/(1 - nu)
  pieces.add_sphere(rag, {0, 0, r - std::pow(F_a / k, 2.0 / 3)});
  WallSet walls;
  walls.add_plane("floor", {}, {0, 0, 1});
  ContactSolver contacts(adhesive(), pieces.rags, &walls);
  const auto overlap_after = [&](double from, double to, double time, double& off) {  // pull over F_a
    const int n = static_cast<int>(std::lround(time / step));
    for (int i = 0; i < n && off == 0; ++i) {
      const double pull = from + (to - from) * i / n;
      pieces.gravity = {0, 0, pull * F_a / rag.mass};
      pieces.advance(contacts, step);
      if (pieces.get(0, Tile::x).z > r) off = pull;
    }
    return r - pieces.get(0, Tile::x).z;
  };
  double off = 0;
  EXPECT_NEAR(overlap_after(0.5, 0.5, 0.02, off) / std::pow(0.5 * F_a / k, 2.0 / 3), 1, 1e-6);
  overlap_after(0.5, 0.97, 0.05, off);
  EXPECT_EQ(off, 0);
  overlap_after(0.97, 1.03, 0.4, off);
  std::printf("parts at %.6f of 2 pi w r\n", off);
  EXPECT_NEAR(off, 1, 1e-3);
}

/// A horizontal cloth that touches a horizontal wall whose normal into the fluid is n, under gravity, after 50 ms.
struct OnWall {
  OnWall(const Vec3& n, const ContactSettings& settings) : rags(MPI_COMM_SELF, {}, {piece()}) {
    walls.add_plane("wall", -0.999e-3 * n, n);
    rags.set_contacts(std::make_unique<ContactSolver>(settings, rags.rags(), &walls));
    rags.set_gravity({0, 0, -9.81});
    for (int k = 0; k < 50; ++k) rags.advance(1e-3);
    at_end = rag_states(rags)[0], load = rags.contacts()->wall_loads(MPI_COMM_SELF)[0];
  }
  static RagPiece piece() {
    RagPiece cloth = testing_pieces::cloth(8, 6);
    cloth.rag.bond_damping = 0.5;
    return cloth;
  }
  double weight() const { return 48 * rags.rags()[0].mass * 9.81; }
  WallSet walls;
  RagSystem rags;
  RagState at_end;
  WallLoad load;
};

TEST(Adhesion, ClothHangsFromACeiling) {
  // Requirement: a cloth pressed to a ceiling stays there and pulls at it with its weight, to 1e-6; without adhesion it falls by g t^2/2.
  const OnWall held({0, 0, -1}, adhesive()), free({0, 0, -1}, {});
  EXPECT_NEAR(-held.load.normal_force.z / held.weight(), 1, 1e-6);
  EXPECT_LT(std::abs(held.at_end.centre.z), 1e-5);
  EXPECT_NEAR(free.at_end.centre.z / (-0.5 * 9.81 * 0.05 * 0.05), 1, 0.02);
}

TEST(Adhesion, UnloadedContactHoldsByFriction) {
  // Requirement: on a vertical wall nothing presses the cloth to it but adhesion: mu F_a a particle carries its weight at mu = 0.5; at mu =
  // 0.02 it slides down with g - mu F_a/m.
  ContactSettings slippery = adhesive();
  slippery.wall_friction = 0.02;
  const Vec3 n{0, 1, 0};
  RagPiece piece = OnWall::piece();
  piece.orientation = rotation_to({1, 0, 0}, {0, 0, 1});
  double fall[2] = {};
  for (const bool slides : {false, true}) {
    WallSet walls;
    walls.add_plane("wall", -0.99e-3 * n, n);
    RagSystem rags(MPI_COMM_SELF, {}, {piece});
    rags.set_contacts(std::make_unique<ContactSolver>(slides ? slippery : adhesive(), rags.rags(), &walls));
    for (int k = 0; k < 30; ++k) rags.advance(1e-3);  // comes to rest at its overlap
    rags.set_gravity({0, 0, -9.81});
    const double start = rag_states(rags)[0].centre.z;
    for (int k = 0; k < 50; ++k) rags.advance(1e-3);
    fall[slides] = start - rag_states(rags)[0].centre.z;
  }
  const double F_a = 2 * std::numbers::pi * w * 1e-3, a = 9.81 - 0.02 * F_a / piece.rag.mass;
  std::printf("slides by %.5g m, g - mu F_a/m gives %.5g m; held %.3g m\n", fall[1], 0.5 * a * 0.05 * 0.05, fall[0]);
  EXPECT_LT(std::abs(fall[0]), 1e-5);
  EXPECT_NEAR(fall[1] / (0.5 * a * 0.05 * 0.05), 1, 0.02);
}

TEST(Adhesion, FrictionOfPieces) {
  // Requirement: a piece's own coefficients replace those of [contact]; between two pieces the geometric mean counts.
  Rag a = testing_pieces::cloth(2, 2).rag, b = a;
  const auto limit = [](const ContactPair& pair) {
    ContactBlock block;
    block.n = 1;
    put(block.normal, 0, {0, 0, -1}), put(block.velocity, 0, {1, 0, 0});
    block.overlap[0] = 1e-5, block.weight[0] = 1;
    pair.law->evaluate(block, pair.rolling, 1e-3);
    return std::abs(block.force[0][0] / block.force[2][0]);
  };
  const ContactSettings settings;
  EXPECT_NEAR(limit(wall_pair(a, settings)), 0.5, 1e-12);
  a.wall_friction = 0.2, a.cloth_friction = 0.9, b.cloth_friction = 0.4;
  EXPECT_NEAR(limit(wall_pair(a, settings)), 0.2, 1e-12);
  EXPECT_NEAR(limit(particle_pair(a, b, settings)), 0.6, 1e-12);
  EXPECT_NEAR(limit(particle_pair(a, a, settings)), 0.9, 1e-12);
}

}  // namespace
}  // namespace snag
