#include "textile/elongation.hpp"

#include <cmath>
#include <numbers>

#include "dem/particles/tile_particles.hpp"
#include "dem/rag_system.hpp"

namespace snag {

namespace {

constexpr double pull_speed =
    0.2;  // m/s: a five-hundredth of the speed of a wave along the bonds; dashpots add less than 0.1 % of the force
constexpr int looks_to_max = 400;  // at the force before the largest is due
constexpr double furthest = 2;     // over max_strain: a cloth that has not torn by then does not tear

/// The cloth between the clamps, pulled along its rows.
RagPiece pulled_cloth(const TextileTests& tests, double radius, const std::array<BondProperties, 2>& bond) {
  const auto whole = [&](double length) { return std::max(1, static_cast<int>(std::lround(length / (2 * radius)))); };
  RagPiece piece;
  Rag& rag = piece.rag;
  rag.name = "grab test", rag.radius = radius;
  rag.n_columns = whole(tests.gauge_length) + 1;
  rag.n_rows = whole(tests.clamp_width);
  rag.mass = tests.elongation_density * tests.thickness * 4 * radius * radius, rag.inertia = 0.4 * rag.mass * radius * radius;
  rag.bond = bond, rag.bond_damping = tests.bond_damping, rag.rotation_friction = 0;
  rag.contact_radius_ratio = tests.contact_radius_ratio;
  rag.breakage = true;
  return piece;
}

/// Pull of the cloth on the clamp of the first column, N.
double clamp_force(const RagSystem& rags) {
  double force = 0;
  for (const Tile& tile : rags.tiles())
    for_particles(tile, [&](int k, int i, int) {
      if (tile.column + i == 0 && tile.free[k] < 0.5) force += tile.field(Tile::fx)[k];
    });
  return force;
}

}  // namespace

BondProperties elongation_bond(const TextileTests& tests, int direction, double radius, bool as_published) {
  const ElongationResult& measured = tests.elongation[direction];
  const double area = std::numbers::pi * radius * radius;
  const double n = (as_published ? 2 : 1) * tests.clamp_width / (2 * radius);
  BondProperties bond;
  bond.normal_strength = measured.max_force / n / area;
  bond.normal_stiffness = bond.normal_strength / (measured.max_strain * 2 * radius);
  return bond;
}

GrabTest simulated_grab_test(const TextileTests& tests, int direction, double radius, const std::array<BondProperties, 2>& bond,
                             double share) {
  const RagPiece piece = pulled_cloth(tests, radius, bond);
  const Rag& rag = piece.rag;
  RagSystem rags(MPI_COMM_SELF, DemSettings{{}, share}, {piece});
  rags.clamp([&](std::int64_t id) { return id % rag.n_columns == 0 || id % rag.n_columns == rag.n_columns - 1; });
  // It begins with the velocities of a steady pull, so that no wave runs through it.
  for (Tile& tile : rags.tiles())
    for_particles(tile, [&](int k, int i, int) {
      tile.set_vector(Tile::vx, k, {pull_speed * (tile.column + i) / (rag.n_columns - 1), 0, 0});
    });
  const double gauge = 2 * radius * (rag.n_columns - 1), max_strain = tests.elongation[direction].max_strain;
  const double look = max_strain * gauge / pull_speed / looks_to_max;
  GrabTest result;
  for (double strain = 0; strain < furthest * max_strain;) {
    rags.advance(look);
    strain = pull_speed * rags.time() / gauge;
    const double force = clamp_force(rags);
    result.strain.push_back(strain), result.force.push_back(force);
    if (force > result.max_force) result.max_force = force, result.strain_at_max = strain;
    if (force < 0.5 * result.max_force) break;
  }
  return result;
}

}  // namespace snag
