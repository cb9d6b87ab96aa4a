// ranks: 1 2 3
// What rags exert on walls: weight, friction, momentum, energy, on any number of ranks.
#include "dem/contacts/wall_loads.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "dem/contacts/contact_solver.hpp"
#include "dem/rag_measures.hpp"
#include "dem/walls/walls.hpp"
#include "parallel/session.hpp"
#include "tests/unit/dem/wall_pieces.hpp"
#include "tests/verification/dem/pieces.hpp"

namespace snag {
namespace {

using namespace testing_pieces;

constexpr double g = 9.81;  // m/s2

struct ClothAndWalls {
  ClothAndWalls(MPI_Comm comm, std::vector<RagPiece> pieces, WallSet all_walls, const ContactSettings& settings = {})
      : walls(std::move(all_walls)), rags(comm, {}, std::move(pieces)) {
    rags.set_contacts(std::make_unique<ContactSolver>(settings, rags.rags(), &walls));
  }
  /// Tiles go round the ranks, then one step.
  void advance(double dt) {
    const int size = size_of(rags.comm());
    rags.migrate([&](const std::vector<Vec3>& centres) {
      std::vector<int> ranks;
      for (const Vec3& c : centres) ranks.push_back((static_cast<int>(std::floor(c.x / 0.005)) + 1000 * size) % size);
      return ranks;
    });
    rags.advance(dt);
    loads = rags.contacts()->wall_loads(rags.comm());
  }
  RagState state() const { return rag_states(rags)[0]; }
  double weight() const { return static_cast<double>(rags.n_particles()) * rags.rags()[0].mass * g; }

  WallSet walls;
  RagSystem rags;
  std::vector<WallLoad> loads;
};

RagPiece damped_cloth(int n_columns, int n_rows) {
  RagPiece piece = cloth(n_columns, n_rows);
  piece.rag.bond_damping = 0.5, piece.rag.rotation_friction = 0.001;
  return piece;
}

WallSet floor_at(double height, const WallMotion& motion = {}) {
  WallSet walls;
  walls.add_plane("floor", {0, 0, height}, {0, 0, 1}, motion);
  return walls;
}

TEST(WallLoads, ClothAtRestWeighsOnAPlate) {
  // Requirement: a cloth that lies on a plate presses it with its weight, to 1e-6, and exerts nothing else.
  ClothAndWalls run(MPI_COMM_WORLD, {damped_cloth(20, 15)}, floor_at(-1e-3));
  run.rags.set_gravity({0, 0, -g});
  for (int k = 0; k < 40; ++k) run.advance(1e-3);
  ASSERT_EQ(run.loads.size(), 1u);
  const WallLoad& load = run.loads[0];
  if (rank_of(MPI_COMM_WORLD) == 0) std::printf("force over weight less 1: %.2g\n", -load.force().z / run.weight() - 1);
  EXPECT_NEAR(-load.normal_force.z / run.weight(), 1, 1e-6);
  EXPECT_LE(norm(load.friction_force), 1e-6 * run.weight());
  EXPECT_EQ(load.power, 0);
}

TEST(WallLoads, BlockThatIsPushedAlongAWallRubsByCoulombsLaw) {
  // Requirement: a stiff block of particles that presses a moving wall by a given overlap drags it with mu N against the wall's motion, N
  // by the law of Hertz; the wall gives this force times its speed.
  ContactSettings settings;
  settings.wall_friction = 0.3;
  const double overlap = 2e-5;
  ClothAndWalls run(MPI_COMM_WORLD, {cloth(12, 8)},
                    floor_at(overlap - 1e-3, {.axis = {0, 0, 1}, .origin = {}, .speed = 0, .velocity = {-0.3, -0.4, 0}}), settings);
  run.rags.clamp([](std::int64_t) { return true; });
  for (int k = 0; k < 3; ++k) run.advance(1e-3);
  const Rag& rag = run.rags.rags()[0];
  const double E = rag.shear_modulus / (1 - rag.poisson_ratio),  // E* of a particle on a wall of its own material: E/(2 (1 - nu^2))
      N = 12 * 8 * 4.0 / 3 * E * std::sqrt(rag.radius) * std::pow(overlap, 1.5);
  const WallLoad& load = run.loads[0];
  EXPECT_LE(norm(load.normal_force - Vec3{0, 0, -N}), 1e-10 * N);
  EXPECT_LE(norm(load.friction_force - 0.3 * N * Vec3{0.6, 0.8, 0}), 1e-10 * N);
  EXPECT_NEAR(load.power / (0.3 * N * 0.5), 1, 1e-10);
}

/// A sheet that is thrown at a floor and against a step of it.
struct Thrown : ClothAndWalls {
  explicit Thrown(MPI_Comm comm) : ClothAndWalls(comm, {thrown()}, step()) {}
  static RagPiece thrown() {
    RagPiece piece = damped_cloth(40, 30);
    piece.velocity = {2, 0.3, -1}, piece.spin = {0, 20, 5}, piece.centre = {0, 0, 0.042};
    return piece;
  }
  static WallSet step() {
    WallSet walls = floor_at(0);
    walls.add_surface("step", test::solid_box({0.035, -0.05, -0.01}, {0.06, 0.05, 0.02}),
                      {.axis = {0, 0, 1}, .origin = {0.1, -0.02, 0}, .speed = 0, .velocity = {}});
    return walls;
  }
};

TEST(WallLoads, WallsTakeWhatTheClothLoses) {
  // Requirement: without gravity the impulses on the walls and the change of the cloth's momentum sum to zero to 1e-10, and so do the
  // angular impulses about the vertical and the change of angular momentum; a horizontal floor has vertical normal forces and horizontal
  // friction.
  Thrown run(MPI_COMM_WORLD);
  const double dt = 5e-4;
  Vec3 impulse;
  double total = 0, on_step = 0, angular = 0, total_angular = 0;
  const RagState start = run.state();
  for (int k = 0; k < 60; ++k) {
    run.advance(dt);
    for (const WallLoad& load : run.loads) impulse += dt * load.force(), total += dt * norm(load.force());
    const WallLoad &floor = run.loads[0], &step = run.loads[1];
    EXPECT_EQ(floor.normal_force.x, 0);
    EXPECT_LE(std::abs(floor.friction_force.z), 1e-14 * norm(floor.force()));
    const double of_step = step.torque() + 0.1 * step.force().y + 0.02 * step.force().x;  // its axis is at (0.1, -0.02) m
    angular += dt * (floor.torque() + of_step), total_angular += dt * (std::abs(floor.torque()) + std::abs(of_step));
    on_step += dt * norm(step.force());
  }
  const RagState end = run.state();
  if (rank_of(MPI_COMM_WORLD) == 0)
    std::printf("momentum %.2g, angular momentum %.2g of what was exchanged\n", norm(end.momentum - start.momentum + impulse) / total,
                std::abs(end.angular_momentum.z - start.angular_momentum.z + angular) / total_angular);
  EXPECT_GT(on_step, 0.1 * total) << "the cloth must meet both walls";
  EXPECT_LE(norm(end.momentum - start.momentum + impulse), 1e-10 * total);
  EXPECT_LE(std::abs(end.angular_momentum.z - start.angular_momentum.z + angular), 1e-10 * total_angular);
}

TEST(WallLoads, AreTheSameOnAnyNumberOfRanks) {
  // Requirement: loads of each wall agree with those of one rank to 1e-12 of the largest, step by step.
  Thrown alone(MPI_COMM_SELF), spread(MPI_COMM_WORLD);
  double largest = 0, difference = 0;
  for (int k = 0; k < 40; ++k) {
    alone.advance(5e-4), spread.advance(5e-4);
    for (std::size_t p = 0; p < alone.loads.size(); ++p) {
      const WallLoad &a = alone.loads[p], &b = spread.loads[p];
      largest = std::max(largest, norm(a.force()));
      difference = std::max({difference, norm(a.normal_force - b.normal_force), norm(a.friction_force - b.friction_force),
                             std::abs(a.torque() - b.torque()) / 0.1, std::abs(a.power - b.power)});
    }
  }
  EXPECT_GT(largest, 1e-2);
  EXPECT_LE(difference, 1e-12 * largest);
}

TEST(WallLoads, TurningFloorTakesAClothAlong) {
  // Requirement: a floor that turns drags a cloth up to its speed. Its angular impulse is the change of the cloth's angular momentum
  // (1e-10), its power is minus torque times speed (1e-12), and torque times angle is the energy of the cloth and the heat of friction,
  // torque times the angle by which the floor ran ahead, within 1 %.
  const double speed = 8, dt = 1e-4;
  RagPiece piece = damped_cloth(20, 20);
  ClothAndWalls run(MPI_COMM_WORLD, {piece}, floor_at(-1e-3, {.axis = {0, 0, 2}, .origin = {}, .speed = speed, .velocity = {}}));
  run.rags.set_gravity({0, 0, -g});
  double moment = 0;  // of inertia, kg m2
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 20; ++i) {
      const double x = (2 * i - 19) * 1e-3, y = (2 * j - 19) * 1e-3;
      moment += piece.rag.mass * (x * x + y * y) + piece.rag.inertia;
    }
  double work = 0, torque_times_angle = 0, heat = 0, impulse = 0, drag = 0;
  const RagState start = run.state();
  double before = start.angular_momentum.z / moment;
  for (int k = 0; k < 400; ++k) {
    run.advance(dt);
    const WallLoad& load = run.loads[0];
    EXPECT_NEAR(load.power, -load.torque() * speed, 1e-12 * std::abs(load.torque() * speed) + 1e-18);
    const double now = run.state().angular_momentum.z / moment;
    work += dt * load.power, torque_times_angle -= load.torque() * speed * dt, heat -= dt * load.torque() * (speed - 0.5 * (before + now));
    impulse -= dt * load.torque(), drag = std::max(drag, std::abs(load.torque()));
    before = now;
  }
  const RagState end = run.state();
  const double energy = end.kinetic_energy + end.bond_energy - start.kinetic_energy;
  if (rank_of(MPI_COMM_WORLD) == 0)
    std::printf(
        "speed of the cloth over that of the floor %.4f, work %.5g J, energy %.5g J, heat %.5g J, (energy + heat)/work - 1 = %.2g\n",
        before / speed, work, energy, heat, (energy + heat) / work - 1);
  EXPECT_NEAR(end.angular_momentum.z - start.angular_momentum.z, impulse, 1e-10 * impulse);
  EXPECT_NEAR(work / torque_times_angle, 1, 1e-12);
  EXPECT_NEAR(before / speed, 1, 0.01);
  EXPECT_NEAR(energy / (0.5 * moment * speed * speed), 1, 0.01);
  EXPECT_NEAR((energy + heat) / work, 1, 0.01);
}

}  // namespace
}  // namespace snag
