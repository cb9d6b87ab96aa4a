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

/// Unit vector along x (0), y (1) or z (2).
Vec3 axis(int k) { return {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0}; }

/// Whether the bond of a pair holds with its second end moved by `shift` and its ends turned by -turn/2 and turn/2 (axis times angle).
bool pair_holds(const RagPiece& pair, const Vec3& shift, const Vec3& turn) {
  RagSystem rags(MPI_COMM_SELF, {}, {pair});
  rags.clamp([](std::int64_t) { return true; });
  for (const int end : {0, 1}) {
    const auto [tile, k] = find(rags, end);
    const double angle = (end - 0.5) * norm(turn);
    tile->field(Tile::qw)[k] = std::cos(angle / 2);
    tile->set_vector(Tile::qx, k, std::sin(angle / 2) * unit(turn));
    if (end == 1) add_to(*tile, Tile::x, k, shift);
  }
  rags.advance(1e-5);
  return rags.check()[0].broken == 0;
}

TEST(BondStatics, BondBreaksByBendingAtItsStrength) {
  // Requirement: N/A + M r/I = S_n e + S_nb beta r at an elongation e and a bend by beta breaks a bond where it exceeds sigma_c, to 1e-6,
  // in both directions, about both axes across the bond; bending alone, helped by tension, and relieved by compression. A twist adds
  // nothing.
  for (const int direction : {0, 1})
    for (const int about : {1 - direction, 2})
      for (const double tension : {0.0, 0.5, -0.5})
        for (const double excess : {-1e-6, 1e-6}) {
          RagPiece pair = pair_along(direction);
          BondProperties& bond = pair.rag.bond[direction];
          pair.rag.breakage = true, bond.shear_strength = 0;
          bond.normal_strength = 0.02 * bond.bending_stiffness * pair.rag.radius;  // a bend by 0.02
          const double elongation = tension * bond.normal_strength / bond.normal_stiffness;
          const Vec3 stretch = (1 + excess) * elongation * axis(direction), bend = (1 + excess) * (1 - tension) * 0.02 * axis(about);
          EXPECT_EQ(pair_holds(pair, stretch, bend), excess < 0) << direction << about << ' ' << tension;
          EXPECT_TRUE(pair_holds(pair, {}, 0.5 * axis(direction)));
        }
}

TEST(BondStatics, BondBreaksAtItsShearStrength) {
  // Requirement: an end moved sideways by s with both ends unturned strains the bond by a shear stress F_s/A = S_t s, a twist by psi by
  // M r/J = S_t psi r; where their sum exceeds the shear strength the bond breaks, to 1e-6, in both directions, to both sides. A bend adds
  // nothing.
  for (const int direction : {0, 1})
    for (const int sideways : {1 - direction, 2})
      for (const double share : {0.0, 0.5, 1.0})  // of the shear force
        for (const double excess : {-1e-6, 1e-6}) {
          RagPiece pair = pair_along(direction);
          BondProperties& bond = pair.rag.bond[direction];
          const double r = pair.rag.radius;
          pair.rag.breakage = true, bond.normal_strength = 0;
          bond.shear_strength = 0.02 * bond.tangential_stiffness * r;  // a twist by 0.02, a displacement of 0.02 r
          const Vec3 shift = (1 + excess) * share * 0.02 * r * axis(sideways), twist = (1 + excess) * (1 - share) * 0.02 * axis(direction);
          EXPECT_EQ(pair_holds(pair, shift, twist), excess < 0) << direction << sideways << ' ' << share;
          EXPECT_TRUE(pair_holds(pair, {}, 0.5 * axis(sideways)));
        }
}

TEST(BondStatics, BondBreaksWhenContactRadiiPart) {
  // Requirement: with no strength given a bond ends where its length exceeds twice the contact radius, at a strain of 1.2 for 2.2 r_p, to
  // 1e-6, in both directions.
  for (const int direction : {0, 1})
    for (const double excess : {-1e-6, 1e-6}) {
      RagPiece pair = pair_along(direction);
      pair.rag.breakage = true, pair.rag.bond[direction].normal_strength = 0;
      EXPECT_EQ(pair_holds(pair, 2e-3 * 1.2 * (1 + excess) * axis(direction), {}), excess < 0) << direction;
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

TEST(BondStatics, CantileverOfBeamsIsExactAtItsParticles) {
  // Requirement: bonds that are beams of Timoshenko give the tip of a cantilever under an end load as y = F L^3/(3 EI) + F L/(kappa G A)
  // for any number of bonds, one included, to 1e-6; with kappa = 0 without the second part.
  const double EI = 6e-8, L = 0.018, F = 1e-4 * EI / (L * L);
  for (const double kappa : {0.0, 0.5})
    for (const int n : {2, 3, 6}) {
      RagPiece piece = beam(n, EI, L);
      const std::shared_ptr<BondLaw> law = bond_laws().make("timoshenko_beam", "test");
      *std::get<double*>(law->parameters().at(0).target) = kappa;
      piece.rag.bond_law = law;
      const double GA = 40 * EI / (L * L);
      piece.rag.bond[0].tangential_stiffness = GA / (2 * piece.rag.radius) / BondSection(piece.rag.radius).area;
      LoadedChain chain(piece, {0, 0, F}, {}, 100, 0.6);
      const double exact = F * L * L * L / (3 * EI) + (kappa > 0 ? F * L / (kappa * GA) : 0);
      EXPECT_NEAR(chain.tip().z / exact, 1, 1e-6) << n << ' ' << kappa;
    }
}

TEST(BondStatics, BeamsTwistAsARoundRod) {
  // Requirement: a chain of n beams under a torque T twists by T L/(G J), G J = 2 (G/E) E I, to 1e-9.
  RagPiece piece = cloth(8, 1);
  piece.rag.bond_damping = 0.5, piece.rag.bond_law = bond_laws().make("timoshenko_beam", "test");
  const BondProperties& bond = piece.rag.bond[0];
  const double l = 2e-3, GJ = 2 * (bond.tangential_stiffness / bond.normal_stiffness) * bond.bending_stiffness * pi * 1e-12 / 4 * l,
               T = 1e-7;
  LoadedChain chain(piece, {}, {T, 0, 0}, 250, 0.2);
  const auto [tile, k] = find(chain.rags, 7);
  const double angle = 2 * std::atan2(tile->field(Tile::qx)[k], tile->field(Tile::qw)[k]);
  EXPECT_NEAR(angle / (T * 7 * l / GJ), 1, 1e-9);
}

/// Tip of a clamped inextensible elastica under a dead load F across its clamp: deflection w/L and u/L, from load = F L^2/EI.
/// Bisshopp and Drucker (1945): sqrt(load) = K(k) - F(k, p), sin(p) = 1/(k sqrt 2); the slope t of the tip is sin(t) = 2 k^2 - 1.
std::array<double, 2> elastica(double load) {
  const double root = std::sqrt(load);
  const auto start = [](double k) { return std::asin(1 / (k * std::numbers::sqrt2)); };
  double low = 1 / std::numbers::sqrt2, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double k = (low + high) / 2;
    (std::comp_ellint_1(k) - std::ellint_1(k, start(k)) < root ? low : high) = k;
  }
  const double k = low;
  return {1 - 2 / root * (std::comp_ellint_2(k) - std::ellint_2(k, start(k))), 1 - std::sqrt(2 * (2 * k * k - 1)) / root};
}

TEST(BondStatics, CantileverUnderLargeLoadFollowsTheElastica) {
  // Requirement: both components of the tip's deflection, w across and u along, follow the elastica up to F L^2/EI = 10: within 1 % of each
  // with 10 particles, and with order 2 in the number of bonds.
  constexpr std::array<std::array<double, 3>, 3> mattiasson{
      {{1, 0.30172, 0.05643}, {5, 0.71379, 0.38763}, {10, 0.81061, 0.55500}}};  // 1981
  const double EI = 6e-8, L = 0.018;
  for (const auto& [load, w, u] : mattiasson) {
    const std::array<double, 2> exact = elastica(load);
    EXPECT_NEAR(exact[0], w, 6e-6);
    EXPECT_NEAR(exact[1], u, 6e-6);
    const auto errors = [&](int n) {
      LoadedChain chain(beam(n, EI, L), {0, 0, load * EI / (L * L)}, {}, 150, 0.5);
      // Bonds as stiff in shear as in tension lengthen by F/k along the load, however they lie, and leave its lever arms as they are.
      const double give = load / 2e4;
      return std::array{(chain.tip().z / L - give) / exact[0] - 1, (1 - chain.tip().x / L) / exact[1] - 1};
    };
    const std::array<double, 2> ten = errors(10), nineteen = errors(19), thirty_seven = errors(37);
    for (const int c : {0, 1}) {
      EXPECT_LT(std::abs(ten[c]), 0.01) << load << "wu"[c];
      EXPECT_NEAR(std::log2(ten[c] / nineteen[c]), 2, 0.1) << load;
      EXPECT_NEAR(std::log2(nineteen[c] / thirty_seven[c]), 2, 0.1) << load;
    }
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
