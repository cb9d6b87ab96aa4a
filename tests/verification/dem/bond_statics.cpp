// Chains of bonded particles at rest under load, against exact solutions.
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "base/error.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

using namespace testing_pieces;
constexpr double pi = std::numbers::pi;

/// A chain clamped at its first particle, loaded at its last by a force and a torque until it rests.
struct LoadedChain {
  LoadedChain(const RagPiece& piece, const Vec3& force, const Vec3& torque, double drag_rate, double time)
      : rags(MPI_COMM_SELF, DemSettings{}, {piece}), last(piece.rag.n_columns - 1) {
    rags.clamp([](std::int64_t id) { return id == 0; });
    rags.set_damping_rate(drag_rate);
    EachParticle load(rags, [&](Tile& tile, int k, std::int64_t id) {
      add_drag(rags, tile, k, drag_rate);
      if (id == last) add_to(tile, Tile::fx, k, force), add_to(tile, Tile::tx, k, torque);
    });
    rags.advance(time, &load);
  }
  Vec3 tip() { return position(rags, last) - position(rags, 0); }

  RagSystem rags;
  std::int64_t last;
};

/// Two particles bonded lengthwise (0) or crosswise (1).
RagPiece pair_along(int direction) { return direction == 0 ? cloth(2, 1) : cloth(1, 2); }
constexpr std::array<Tile::Field, 2> along{Tile::x, Tile::y};

TEST(BondStatics, TwoParticlesElongateByForceOverStiffness) {
  // Requirement: elongation F/(S_n A) in both directions, to 1e-9 of it.
  for (const int direction : {0, 1}) {
    RagPiece pair = pair_along(direction);
    pair.rag.bond_damping = 0.5;
    const double stiffness = pair.rag.bond[direction].normal_stiffness * pi * 1e-6, F = 0.4;
    Vec3 force;
    force[direction] = F;
    RagSystem rags(MPI_COMM_SELF, {}, {pair});
    rags.clamp([](std::int64_t id) { return id == 0; });
    rags.set_damping_rate(3e4);
    EachParticle load(rags, [&](Tile& tile, int k, std::int64_t id) {
      add_drag(rags, tile, k, 3e4);
      if (id == 1) add_to(tile, Tile::fx, k, force);
    });
    rags.advance(0.02, &load);
    const Vec3 end = position(rags, 1) - position(rags, 0);
    EXPECT_NEAR((end[direction] - 2e-3) / (F / stiffness), 1, 1e-9);
  }
}

TEST(BondStatics, BondBreaksAtItsStrength) {
  // Requirement: under pure tension a bond holds below sigma_c A and breaks above, once and for good, in both directions.
  for (const int direction : {0, 1})
    for (const double excess : {-1e-6, 1e-6}) {
      RagPiece pair = pair_along(direction);
      pair.rag.breakage = true;
      RagSystem rags(MPI_COMM_SELF, {}, {pair});
      rags.clamp([](std::int64_t) { return true; });
      const BondProperties& bond = pair.rag.bond[direction];
      const double strain = bond.normal_strength / bond.normal_stiffness / 2e-3 * (1 + excess);
      const auto [tile, k] = find(rags, 1);
      double& place = tile->field(along[direction])[k];
      place += 2e-3 * strain;
      rags.advance(1e-5);
      EXPECT_EQ(rags.check()[0].broken, excess > 0 ? 1 : 0);
      place -= 2e-3 * strain;
      rags.advance(1e-5);
      EXPECT_EQ(rags.check()[0].broken, excess > 0 ? 1 : 0);
      EXPECT_EQ(direction == 0 ? tile->bond_x[k - 1] : tile->bond_y[k - tile->stride], excess > 0 ? 0.0 : 1.0);
    }
}

TEST(BondStatics, BondBreaksAtItsShearStrength) {
  // Requirement: an end moved sideways by s strains the bond by a shear force of S_t A s (both ends unturned, to first order in s/l0) and
  // breaks it where that exceeds the shear strength times A; twist by an angle psi where S_t J psi r/J does.
  for (const double excess : {-1e-6, 1e-6}) {
    RagPiece pair = cloth(2, 1);
    pair.rag.breakage = true;
    pair.rag.bond[0].normal_strength = 0;
    const double strength = 0.02 * pair.rag.bond[0].tangential_stiffness * 1e-3;  // Pa: an angle of 0.02, a displacement of 0.02 r
    pair.rag.bond[0].shear_strength = strength;
    {
      RagSystem rags(MPI_COMM_SELF, {}, {pair});
      rags.clamp([](std::int64_t) { return true; });
      const auto [tile, k] = find(rags, 1);
      tile->field(Tile::y)[k] += 0.02e-3 * (1 + excess);
      rags.advance(1e-5);
      EXPECT_EQ(rags.check()[0].broken, excess > 0 ? 1 : 0);
    }
    RagSystem rags(MPI_COMM_SELF, {}, {pair});
    rags.clamp([](std::int64_t) { return true; });
    const auto [tile, k] = find(rags, 1);
    const double half = 0.01 * (1 + excess);
    tile->field(Tile::qw)[k] = std::cos(half), tile->field(Tile::qx)[k] = std::sin(half);
    rags.advance(1e-5);
    EXPECT_EQ(rags.check()[0].broken, excess > 0 ? 1 : 0);
  }
}

TEST(BondStatics, BondBreaksWhenContactRadiiPart) {
  // Requirement: with no strength given a bond ends where its length exceeds twice the contact radius, at a strain of 1.2 for 2.2 r_p.
  for (const double strain : {1.19, 1.21}) {
    RagPiece pair = cloth(2, 1);
    pair.rag.breakage = true, pair.rag.bond[0].normal_strength = 0;
    RagSystem rags(MPI_COMM_SELF, {}, {pair});
    rags.clamp([](std::int64_t) { return true; });
    const auto [tile, k] = find(rags, 1);
    tile->field(Tile::x)[k] += 2e-3 * strain;
    rags.advance(1e-5);
    EXPECT_EQ(rags.check()[0].broken, strain > 1.2 ? 1 : 0);
  }
}

/// A chain of n particles that hardly stretches or shears; its bending stiffness is EI = S_nb I l0.
RagPiece beam(int n, double EI, double length) {
  RagPiece piece = cloth(n, 1);
  Rag& rag = piece.rag;
  rag.radius = length / (n - 1) / 2;
  rag.mass = 2e-5 / n, rag.inertia = 0.4 * rag.mass * rag.radius * rag.radius;
  const double l0 = 2 * rag.radius, A = pi * rag.radius * rag.radius, I = pi * std::pow(rag.radius, 4) / 4;
  const double stiff = 2e4 * EI / (length * length * length) * (n - 1);
  rag.bond[0] = {stiff / A, stiff / A, EI / l0 / I, 0, 0};
  rag.bond_damping = 0.3;
  return piece;
}

TEST(BondStatics, CantileverOfTenParticlesBendsAsEulerAndBernoulliSay) {
  // Requirement: small tip load, y = F L^3/(3 EI) within 1 %; with twice the bonds the difference falls to a quarter (order 2).
  const double EI = 6e-8, L = 0.018, F = 1e-3 * EI / (L * L);
  const auto error = [&](int n) {
    LoadedChain chain(beam(n, EI, L), {0, 0, F}, {}, 150, 0.6);
    const double shear = F / (2e4 * EI / (L * L * L));  // of n - 1 bonds in series
    return (chain.tip().z - shear) / (F * L * L * L / (3 * EI)) - 1;
  };
  const double ten = error(10), nineteen = error(19);
  EXPECT_LT(std::abs(ten), 0.01);
  EXPECT_NEAR(std::log2(ten / nineteen), 2, 0.1);
}

TEST(BondStatics, CantileverUnderLargeLoadFollowsTheElastica) {
  // Requirement: tip of an inextensible elastica under a dead load, Mattiasson (1981): F L^2/EI, w/L, u/L; within 1 % with 10 particles.
  constexpr std::array<std::array<double, 3>, 3> exact{{{1, 0.30172, 0.05643}, {5, 0.71379, 0.38763}, {10, 0.81061, 0.55500}}};
  const double EI = 6e-8, L = 0.018;
  for (const auto& [load, w, u] : exact) {
    LoadedChain chain(beam(10, EI, L), {0, 0, load * EI / (L * L)}, {}, 150, 0.5);
    EXPECT_NEAR(chain.tip().z / L, w, 0.01 * w) << load;
    EXPECT_NEAR(1 - chain.tip().x / L, u, 0.01) << load;
  }
}

TEST(BondStatics, TorsionOfAChainAddsUp) {
  // Requirement: n bonds in series under a torque T twist by n T/(S_t J), to 1e-9.
  RagPiece piece = cloth(8, 1);
  piece.rag.bond_damping = 0.5;
  const double J = pi * 1e-12 / 2, T = 1e-6;
  LoadedChain chain(piece, {}, {T, 0, 0}, 1e3, 0.1);
  const auto [tile, k] = find(chain.rags, 7);
  const double angle = 2 * std::atan2(tile->field(Tile::qx)[k], tile->field(Tile::qw)[k]);
  EXPECT_NEAR(angle / (7 * T / (piece.rag.bond[0].tangential_stiffness * J)), 1, 1e-9);
}

TEST(BondStatics, ClampCarriesTheLoad) {
  // Requirement: at rest the bonds pull the clamped particle with the force at the other end.
  RagPiece piece = cloth(5, 1);
  piece.rag.bond_damping = 0.5;
  const Vec3 F{0.1, 0, 0};
  LoadedChain chain(piece, F, {}, 1e4, 0.05);
  EXPECT_NEAR(chain.rags.tiles()[0].field(Tile::fx)[chain.rags.tiles()[0].index(0, 0)], F.x, 1e-9);
}

}  // namespace
}  // namespace snag
