// Bonded particles in motion: exact oscillations, what is conserved, and the order of the integrator.
#include <gtest/gtest.h>

#include <numbers>

#include "base/error.hpp"
#include "dem/rag_measures.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

using namespace testing_pieces;

/// Sets velocities and spins that excite stretch, shear, bending and torsion.
void shake(RagSystem& rags, double speed) {
  for (Tile& tile : rags.tiles())
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i) {
        const double a = tile.column + i, b = tile.row + j;
        tile.set_vector(Tile::vx, tile.index(i, j),
                        speed * Vec3{std::sin(1.1 * b + 0.3), std::cos(0.9 * a), 2 * std::sin(0.8 * a) * std::cos(0.7 * b)});
        tile.set_vector(Tile::wx, tile.index(i, j),
                        speed / 1e-3 * Vec3{0.3 * std::sin(0.5 * a + b), 0.2 * std::cos(a), 0.1 * std::sin(a * b)});
      }
}

TEST(BondDynamics, PairOscillatesAsADampedSpring) {
  // Requirement: two bonded particles after an impact along the bond follow x = v/w_d exp(-zeta w t) sin(w_d t), w^2 = 2 k/m,
  // zeta = c_d/sqrt(2), which is Eq. 1.1 of the thesis's appendix with m_eq = m/2.
  for (const double c_d : {0.0, 0.5}) {
    RagPiece pair = cloth(2, 1);
    pair.rag.bond_damping = c_d;
    const double k = pair.rag.bond[0].normal_stiffness * std::numbers::pi * 1e-6, w = std::sqrt(2 * k / pair.rag.mass),
                 zeta = c_d / std::sqrt(2);
    const double w_d = w * std::sqrt(1 - zeta * zeta), v = 0.02, t = 0.8 / w;
    const auto error = [&](double step) {
      RagSystem rags(MPI_COMM_SELF, {.step = step, .safety = 1}, {pair});
      find(rags, 0).first->field(Tile::vx)[find(rags, 0).second] = v / 2;
      find(rags, 1).first->field(Tile::vx)[find(rags, 1).second] = -v / 2;
      rags.advance(t);
      const double x = 2e-3 - norm(position(rags, 1) - position(rags, 0));
      return std::abs(x / (v / w_d * std::exp(-zeta * w * t) * std::sin(w_d * t)) - 1);
    };
    const double coarse = error(t / 200), fine = error(t / 400);
    EXPECT_LT(fine, 2e-3);
    EXPECT_NEAR(std::log2(coarse / fine), c_d > 0 ? 1 : 2, 0.1);  // the dashpot sees the velocity half a step late
  }
}

TEST(BondDynamics, IntegratorIsOfSecondOrder) {
  // Requirement: positions and orientations of an undamped sheet converge with order 2.
  const double t = 2e-3;
  const auto state = [&](int n) {
    RagSystem rags(MPI_COMM_SELF, {.step = t / n, .safety = 1}, {cloth(6, 5)});
    shake(rags, 0.05);
    rags.advance(t);
    std::vector<double> values;
    const Tile& tile = rags.tiles()[0];
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i)
        for (int f = Tile::x; f <= Tile::z; ++f) {
          values.push_back(tile.field(f)[tile.index(i, j)]);
          values.push_back(1e-3 * tile.field(Tile::qx + f)[tile.index(i, j)]);
        }
    return values;
  };
  const std::vector<double> exact = state(6400), coarse = state(200), fine = state(400);
  double error_coarse = 0, error_fine = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) error_coarse += std::abs(coarse[k] - exact[k]), error_fine += std::abs(fine[k] - exact[k]);
  EXPECT_NEAR(std::log2(error_coarse / error_fine), 2, 0.1);
}

TEST(BondDynamics, RotationIsExactForAConstantSpin) {
  // Requirement: a free sphere turns by exactly w t, and its quaternion stays a unit one.
  RagPiece sphere = cloth(1, 1);
  sphere.spin = {300, -200, 500};
  RagSystem rags(MPI_COMM_SELF, {.step = 1e-3, .safety = 1}, {sphere});
  rags.advance(0.5);
  const Tile& tile = rags.tiles()[0];
  const int k = tile.index(0, 0);
  const double w = norm(sphere.spin), half = 0.25 * w;
  EXPECT_NEAR(tile.field(Tile::qw)[k], std::cos(half), 1e-12);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(tile.field(Tile::qx + c)[k], std::sin(half) * sphere.spin[c] / w, 1e-12);
}

TEST(BondDynamics, UndampedSheetKeepsItsEnergy) {
  // Requirement: energy of a vibrating undamped sheet drifts by less than 1e-4 over 1e6 steps (means over 1000 steps compared).
  RagSystem rags(MPI_COMM_SELF, {.step = {}, .safety = 0.3}, {cloth(12, 9)});
  shake(rags, 0.05);
  const double step = rags.stable_step();
  const auto mean_energy = [&] {
    double sum = 0;
    for (int k = 0; k < 100; ++k) {
      rags.advance(10 * step);
      const RagState s = rag_states(rags)[0];
      sum += s.kinetic_energy + s.bond_energy;
    }
    return sum / 100;
  };
  const double before = mean_energy();
  rags.advance(998000 * step);
  const double after = mean_energy();
  EXPECT_NEAR(after / before, 1, 1e-4);
  EXPECT_EQ(rags.n_sub_steps(), 1000000);
}

TEST(BondDynamics, FreeSheetKeepsMomentum) {
  // Requirement: linear and angular momentum of a free sheet stay to 1e-12, with dashpots and friction, over 2000 steps and several tiles.
  RagPiece piece = cloth(40, 35);
  piece.rag.bond_damping = 0.5, piece.rag.rotation_friction = 0.001;
  piece.velocity = {0.3, 0.1, -0.2}, piece.spin = {5, 20, 10};
  RagSystem rags(MPI_COMM_SELF, {}, {piece});
  shake(rags, 0.1);
  const RagState before = rag_states(rags)[0];
  rags.advance(2000 * rags.stable_step());
  const RagState after = rag_states(rags)[0];
  const double scale = 0.1 * rags.n_particles() * piece.rag.mass;
  EXPECT_LT(norm(after.momentum - before.momentum), 1e-12 * scale);
  EXPECT_LT(norm(after.angular_momentum - before.angular_momentum), 1e-12 * scale * 0.04);
  EXPECT_LT(after.kinetic_energy + after.bond_energy, before.kinetic_energy + before.bond_energy);
}

TEST(BondDynamics, BondForcesTurnWithABentSheet) {
  // Requirement: a bent sheet turned as a whole carries bond forces turned with it, to 1e-9: evaluated by the kernel of the tiles.
  RagPiece piece = cloth(20, 10);
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 20; ++column) {
      const double radius = 12e-3, angle = 2e-3 * column / radius;  // rolled onto a cylinder, slightly sheared
      piece.poses.push_back({{radius * std::sin(angle), 2.05e-3 * row + 1e-4 * column, radius * (1 - std::cos(angle))},
                             {std::cos(angle / 2), 0, -std::sin(angle / 2), 0}});
    }
  RagPiece turned = piece;
  const Quaternion Q = rotation_to({0.3, -0.5, 0.8}, {1, 0.2, 0.1});
  for (ParticlePose& pose : turned.poses) {
    pose.position = rotate(Q, pose.position) + Vec3{0.1, -0.2, 0.3};
    const Quaternion q = pose.orientation;
    pose.orientation = {Q.w * q.w - Q.x * q.x - Q.y * q.y - Q.z * q.z, Q.w * q.x + Q.x * q.w + Q.y * q.z - Q.z * q.y,
                        Q.w * q.y - Q.x * q.z + Q.y * q.w + Q.z * q.x, Q.w * q.z + Q.x * q.y - Q.y * q.x + Q.z * q.w};
  }
  const TileGrid grid = tile_grid(20, 10);
  Tile a = make_tile(piece, 0, grid, 0), b = make_tile(turned, 0, grid, 0);
  const BondLaws laws = bond_laws(piece.rag);
  set_bond_forces(laws, false, a);
  set_bond_forces(laws, false, b);
  double largest = 0, force = 0, torque = 0;
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 20; ++i) {
      const int k = a.index(i, j);
      largest = std::max(largest, norm(a.vector(Tile::fx, k)));
      force = std::max(force, norm(b.vector(Tile::fx, k) - rotate(Q, a.vector(Tile::fx, k))));
      torque = std::max(torque, norm(b.vector(Tile::tx, k) - rotate(Q, a.vector(Tile::tx, k))));
    }
  EXPECT_GT(largest, 1e-3);
  EXPECT_LT(force, 1e-9 * largest);
  EXPECT_LT(torque, 1e-9 * largest * 1e-3);
}

TEST(BondDynamics, StepAboveTheLimitIsRefused) {
  // Requirement: a given step above the stable one is an error that names what sets the limit; at 0.98 of the limit all waves stay bounded.
  RagPiece piece = cloth(8, 8);
  const double limit = stable_bond_step(piece.rag).step;
  EXPECT_NEAR(limit, 2 / std::sqrt(4 * 2403.3 / 2.25e-6), 0.02 * limit);
  try {
    RagSystem rags(MPI_COMM_SELF, {.step = 1.01 * limit, .safety = 1}, {piece});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("normal stiffness lengthwise"), std::string::npos) << error.what();
  }
  for (const double damping : {0.0, 0.5}) {
    piece.rag.bond_damping = damping;
    RagSystem rags(MPI_COMM_SELF, {.step = {}, .safety = 0.98}, {piece});
    shake(rags, 1e-6);
    const double before = rag_states(rags)[0].kinetic_energy;
    rags.advance(3000 * rags.stable_step());
    EXPECT_LT(rag_states(rags)[0].kinetic_energy, 50 * before);
  }
}

}  // namespace
}  // namespace snag
