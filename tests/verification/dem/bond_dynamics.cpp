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
void shake(std::vector<Tile>& tiles, double speed) {
  for (Tile& tile : tiles)
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
    shake(rags.tiles(), 0.05);
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
  shake(rags.tiles(), 0.05);
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
  shake(rags.tiles(), 0.1);
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
  const auto bonds = bonds_of(piece.rag);
  bonds->set_forces(false, a, b);
  bonds->set_forces(false, b, a);
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
    shake(rags.tiles(), 1e-6);
    const double before = rag_states(rags)[0].kinetic_energy;
    rags.advance(3000 * rags.stable_step());
    EXPECT_LT(rag_states(rags)[0].kinetic_energy, 50 * before);
  }
}

/// The fastest wave of a piece: its phase is pi from particle to particle, so that one stiffness works alone.
struct FastestWave {
  const char* reason;
  RagPiece piece;
  double drag, strain;         // on all particles, 1/s; of a chain held at both ends, 0: free
  double omega_squared, rate;  // 4 k/m, 1/s2; 4 c/m and drag, 1/s

  /// (2/omega)(sqrt(1 + zeta^2) - zeta), zeta = rate/(2 omega)
  double critical_step() const {
    const double omega = std::sqrt(omega_squared), zeta = rate / (2 * omega);
    return 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
  }
};

/// Of chains and a sheet, by stretch and by bending, for the dashpots' c_d and drag.
std::vector<FastestWave> fastest_waves(double c_d, double drag) {
  const double A = std::numbers::pi * 1e-6, I = std::numbers::pi * 1e-12 / 4;
  RagPiece chain = cloth(60, 1), sheet = cloth(40, 14), stiff = cloth(60, 1);
  stiff.rag.bond[0].bending_stiffness *= 100;
  for (RagPiece* piece : {&chain, &sheet, &stiff}) piece->rag.bond_damping = c_d;
  RagPiece rubbing = stiff;
  rubbing.rag.rotation_friction = 0.001;
  const double m = chain.rag.mass, i = chain.rag.inertia;
  const double stretch = chain.rag.bond[0].normal_stiffness * A, shear = sheet.rag.bond[1].tangential_stiffness * A,
               bend = stiff.rag.bond[0].bending_stiffness * I, twist = stiff.rag.bond[0].tangential_stiffness * 2 * I;
  const auto dashpot = [&](double stiffness, double inertia) { return c_d * std::sqrt(stiffness * inertia); };
  const double friction = std::sqrt(std::min(bend, twist) * i);
  return {
      {"normal stiffness lengthwise", chain, drag, 0, 4 * stretch / m, 4 * dashpot(stretch, m) / m + drag},
      // Alternating along and across, it shears the bonds crosswise.
      {"normal stiffness lengthwise", sheet, drag, 0, 4 * (stretch + shear) / m, 4 * (dashpot(stretch, m) + dashpot(shear, m)) / m + drag},
      {"bending stiffness lengthwise", stiff, drag, 0, 4 * bend / i, 4 * dashpot(bend, i) / i},
      // Friction of slow rotations is a dashpot where bonds carry a force.
      {"bending stiffness lengthwise", rubbing, drag, 0.01, 4 * bend / i, 4 * (dashpot(bend, i) + friction) / i}};
}

TEST(BondDynamics, StepLimitIsThatOfTheFastestWave) {
  // Requirement: the stable step is (2/omega)(sqrt(1 + zeta^2) - zeta), to 1e-9, for stretch and for bending, with dashpots, drag and
  // friction of rotation.
  for (const double c_d : {0.0, 0.5, 1.0})
    for (const double drag : {0.0, 2e4})
      for (const FastestWave& wave : fastest_waves(c_d, drag)) {
        const StepLimit limit = stable_bond_step(wave.piece.rag, drag);
        EXPECT_NEAR(limit.step / wave.critical_step(), 1, 1e-9) << wave.reason;
        EXPECT_NE(limit.reason.find(wave.reason), std::string::npos) << limit.reason;
      }
}

/// Factor by which the kinetic energy of a trembling piece grows in 3000 steps of leapfrog, or until it has passed 1e6.
double growth(const FastestWave& wave, double step) {
  const Rag& rag = wave.piece.rag;
  std::vector<Tile> tiles{make_tile(wave.piece, 0, tile_grid(rag.n_columns, rag.n_rows), 0)};
  shake(tiles, 1e-6);
  Tile& tile = tiles[0];
  const int first = tile.index(0, 0), last = tile.index(tile.nx - 1, 0);
  if (wave.strain > 0) {
    for (int k = first; k <= last; ++k) tile.field(Tile::x)[k] *= 1 + wave.strain;
    for (const int k : {first, last}) tile.free[k] = 0, tile.set_vector(Tile::vx, k, {}), tile.set_vector(Tile::wx, k, {});
  }
  const auto for_each = [&](const auto& action) {
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i) action(tile.index(i, j));
  };
  const auto energy = [&] {
    double twice = 0;
    for_each(
        [&](int k) { twice += rag.mass * norm_squared(tile.vector(Tile::vx, k)) + rag.inertia * norm_squared(tile.vector(Tile::wx, k)); });
    return twice / 2;
  };
  const double before = energy();
  const auto bonds = bonds_of(rag);
  drift(tile, step / 2);
  for (int n = 0; n < 3000 && energy() < 1e6 * before; ++n) {
    bonds->set_forces(false, tile, tile);
    for_each([&](int k) { add_to(tile, Tile::fx, k, -wave.drag * rag.mass * tile.vector(Tile::vx, k)); });
    kick_and_drift(tile, {rag.mass, rag.inertia, {}}, step, step);
  }
  return energy() / before;
}

TEST(BondDynamics, StepLimitIsSharp) {
  // Requirement: one per cent below the limit all waves stay bounded, one per cent above it they grow without bound. Phase pi belongs to an
  // infinite lattice: a free chain of n particles has its limit 1/cos(pi/2n) higher, 0.03 % for 60, 0.1 % for the sheet's 40.
  for (const double c_d : {0.0, 0.5, 1.0})
    for (const double drag : {0.0, 2e4})
      for (const FastestWave& wave : fastest_waves(c_d, drag)) {
        const double limit = stable_bond_step(wave.piece.rag, drag).step;
        const double below = growth(wave, 0.99 * limit), above = growth(wave, 1.01 * limit);
        EXPECT_LT(below, 50) << wave.reason << c_d;  // of velocities near the limit: 1/(1 - 0.99^2)
        EXPECT_GE(above, 1e6) << wave.reason << c_d;
      }
}

TEST(BondDynamics, StepLimitIsSharpForEveryLaw) {
  // Requirement: as above, for a chain and a sheet of each law of the registry, with dashpots and without.
  for (const std::string& name : bond_laws().names())
    for (const double c_d : {0.0, 0.5})
      for (RagPiece piece : {cloth(60, 1), cloth(40, 14)}) {
        piece.rag.bond_damping = c_d, piece.rag.bond_law = bond_laws().make(name, "test");
        const FastestWave wave{name.c_str(), piece, 0, 0, 0, 0};
        const double limit = stable_bond_step(piece.rag).step;
        EXPECT_LT(growth(wave, 0.99 * limit), 50) << name << c_d;
        EXPECT_GE(growth(wave, 1.01 * limit), 1e6) << name << c_d;
      }
}

/// What the bond of a pair does at given velocities of its ends; the pair is turned as a whole, and stretched.
struct BondOnEnds {
  Vec3 along, across;        // unit vectors: of the bond and one across it
  Vec3 force[2], torque[2];  // on the ends, N, N m

  struct Motion {
    Vec3 v[2], w[2];
  };
  /// `motion` makes the velocities from along and across.
  template <class Motions>
  BondOnEnds(const Rag& rag, int direction, double elongation, const Motions& motion) {
    RagPiece piece = pair_along(direction);
    piece.rag = rag;
    piece.orientation = rotation_to({0.3, -0.5, 0.8}, {1, 0.2, 0.1});
    Tile tile = make_tile(piece, 0, tile_grid(rag.n_columns, rag.n_rows), 0);
    const int place[2] = {tile.index(0, 0), direction == 0 ? tile.index(1, 0) : tile.index(0, 1)};
    along = unit(tile.vector(Tile::x, place[1]) - tile.vector(Tile::x, place[0]));
    across = unit(cross(along, Vec3{0.2, 0.7, -0.4}));
    add_to(tile, Tile::x, place[1], elongation * along);
    const Motion given = motion(along, across);
    for (const int end : {0, 1}) tile.set_vector(Tile::vx, place[end], given.v[end]), tile.set_vector(Tile::wx, place[end], given.w[end]);
    bonds_of(rag)->set_forces(false, tile, tile);
    for (const int end : {0, 1}) force[end] = tile.vector(Tile::fx, place[end]), torque[end] = tile.vector(Tile::tx, place[end]);
  }
};

void expect_vector(const Vec3& value, const Vec3& expected, double scale, const char* what) {
  EXPECT_LE(norm(value - expected), 1e-9 * scale) << what;
}

TEST(BondDynamics, DashpotsHaveTheSizeOfTheirFormula) {
  // Requirement: each relative motion of the two ends at rest length meets its dashpot alone, c = c_d sqrt(k m) for S_n A, S_t A and
  // c_d sqrt(k i) for S_nb I, S_t J, on both ends, to 1e-9; common turning about an axis across the bond shears it.
  using Motion = BondOnEnds::Motion;
  for (const int direction : {0, 1}) {
    Rag rag = pair_along(direction).rag;
    rag.bond_damping = 0.4;
    const double r = rag.radius, l = 2 * r, A = std::numbers::pi * r * r, I = std::numbers::pi * r * r * r * r / 4;
    const BondProperties& bond = rag.bond[direction];
    const double c_n = 0.4 * std::sqrt(bond.normal_stiffness * A * rag.mass),
                 c_t = 0.4 * std::sqrt(bond.tangential_stiffness * A * rag.mass),
                 c_bend = 0.4 * std::sqrt(bond.bending_stiffness * I * rag.inertia),
                 c_twist = 0.4 * std::sqrt(bond.tangential_stiffness * 2 * I * rag.inertia);
    const double v = 0.3, w = 40;
    const auto expect = [&](const BondOnEnds& on, const Vec3& force_2, const Vec3& torque_1, const Vec3& torque_2, const char* what) {
      const double force = std::max(norm(force_2), c_t * v), torque = std::max(norm(torque_2), c_bend * w);
      expect_vector(on.force[1], force_2, force, what);
      expect_vector(on.force[0], -force_2, force, what);
      expect_vector(on.torque[0], torque_1, torque, what);
      expect_vector(on.torque[1], torque_2, torque, what);
    };
    const BondOnEnds stretched(rag, direction, 0, [&](const Vec3& n, const Vec3&) { return Motion{{{}, v * n}, {}}; });
    expect(stretched, -c_n * v * stretched.along, {}, {}, "stretch");

    const BondOnEnds sheared(rag, direction, 0, [&](const Vec3&, const Vec3& t) { return Motion{{-0.5 * v * t, 0.5 * v * t}, {}}; });
    const Vec3 moment = 0.5 * l * c_t * v * cross(sheared.along, sheared.across);
    expect(sheared, -c_t * v * sheared.across, moment, moment, "shear");

    const BondOnEnds turning(rag, direction, 0, [&](const Vec3&, const Vec3& t) { return Motion{{}, {w * t, w * t}}; });
    const Vec3 brake = -0.5 * l * l * c_t * w * turning.across;
    expect(turning, c_t * w * l * cross(turning.across, turning.along), brake, brake, "common turning");

    const BondOnEnds bent(rag, direction, 0, [&](const Vec3&, const Vec3& t) { return Motion{{}, {-0.5 * w * t, 0.5 * w * t}}; });
    expect(bent, {}, c_bend * w * bent.across, -c_bend * w * bent.across, "bending");

    const BondOnEnds twisted(rag, direction, 0, [&](const Vec3& n, const Vec3&) { return Motion{{}, {-0.5 * w * n, 0.5 * w * n}}; });
    expect(twisted, {}, c_twist * w * twisted.along, -c_twist * w * twisted.along, "torsion");

    const BondOnEnds rigid(rag, direction, 0, [&](const Vec3& n, const Vec3& t) {
      return Motion{{{0.1, 0.2, 0.3}, Vec3{0.1, 0.2, 0.3} + l * w * cross(t, n)}, {w * t, w * t}};
    });
    expect(rigid, {}, {}, {}, "rigid motion");
  }
}

TEST(BondDynamics, RotationFrictionHasTheSizeOfItsFormula) {
  // Requirement: M = c_r |F_n| r_p against the relative rotation w, of either sign of F_n, dashpots' part included: M w/sqrt(w^2 +
  // (M/c_f)^2), c_f^2 = min(S_nb I, S_t J) i, to 1e-9: half of it at 0.577 M/c_f, all of it for fast rotations.
  using Motion = BondOnEnds::Motion;
  for (const int direction : {0, 1})
    for (const double strain : {0.01, -0.02})
      for (const double c_d : {0.0, 0.5})
        for (const double times : {1e-3, 1 / std::sqrt(3.0), 1e6}) {
          Rag rag = pair_along(direction).rag;
          rag.bond_damping = c_d, rag.rotation_friction = 0.1;
          const double r = rag.radius, A = std::numbers::pi * r * r, I = std::numbers::pi * r * r * r * r / 4, v_n = 0.5;
          const BondProperties& bond = rag.bond[direction];
          const double k_n = bond.normal_stiffness * A, k_bend = bond.bending_stiffness * I, k_twist = bond.tangential_stiffness * 2 * I;
          const double F_n = k_n * strain * 2 * r + c_d * std::sqrt(k_n * rag.mass) * v_n, M = 0.1 * std::abs(F_n) * r;
          const double c_f = std::sqrt(std::min(k_bend, k_twist) * rag.inertia), w = times * M / c_f;
          const auto turn = [&](const Vec3& n, const Vec3& t) { return 0.6 * w * n + 0.8 * w * t; };
          const BondOnEnds on(rag, direction, strain * 2 * r, [&](const Vec3& n, const Vec3& t) {
            return Motion{{{}, v_n * n}, {-0.5 * turn(n, t), 0.5 * turn(n, t)}};
          });
          const Vec3 expected = M * times / std::sqrt(times * times + 1) * (0.6 * on.along + 0.8 * on.across) +
                                0.6 * c_d * std::sqrt(k_twist * rag.inertia) * w * on.along +
                                0.8 * c_d * std::sqrt(k_bend * rag.inertia) * w * on.across;
          expect_vector(on.torque[0], expected, norm(expected), "first end");
          expect_vector(on.torque[1], -expected, norm(expected), "second end");
          expect_vector(on.force[1], -F_n * on.along, std::abs(F_n), "force");
        }
}

}  // namespace
}  // namespace snag
