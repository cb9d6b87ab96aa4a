#include "textile/drape.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "dem/walls/walls.hpp"
#include "observe/silhouette.hpp"
#include "textile/still_air.hpp"

namespace snag {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int n_rim = 240;            // corners of the table: 0.04 mm between chord and circle of 100 mm
constexpr double table_height = 0.2;  // m, more than the cloth hangs
constexpr double start_speed = 0.05;  // rms of the waves it begins with, m/s
constexpr int n_waves = 8;
constexpr double pin_over_radius = 1.5;   // particles whose centres are within this of the axis are held: four, or one
constexpr double fastest_impact = 1;      // that the step resolves, m/s
constexpr double drape_tolerance = 2e-4;  // m, of the places at rest

/// A round table, top at z = 0, closed at the side: normals out of the fluid, so into the table. Every second corner of the top is cut off
/// with its two neighbours, then every second of those that are left, and so on: few triangles lie below a particle, where a fan from the
/// middle would have hundreds.
WallSurface table(double radius) {
  WallSurface surface;
  surface.parts = {"table"};
  // Nodes: the rim above, the rim below.
  const auto node = [&](int i) {
    const double angle = 2 * pi * (i % n_rim) / n_rim;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), i < n_rim ? 0 : -table_height};
  };
  const auto add = [&](int i, int j, int k) {
    const Vec3 a = node(i), b = node(j), c = node(k);
    surface.triangles.push_back({{a, b, c}, unit(cross(b - a, c - a)), 0, {i, j, k}, static_cast<int>(surface.triangles.size())});
  };
  for (int step = 1; 2 * step < n_rim; step *= 2)
    for (int i = 0; i + step < n_rim; i += 2 * step)
      if (const int next = i + 2 * step < n_rim ? i + 2 * step : 0; next != i) add(next, i + step, i);
  for (int a = 0; a < n_rim; ++a) {
    const int b = (a + 1) % n_rim, c = a + n_rim, d = b + n_rim;
    add(a, b, c), add(b, d, c);
  }
  return surface;
}

RagPiece round_cloth(const DrapeTest& test, const DrapeCloth& cloth, const RagSheet* start) {
  RagPiece piece;
  Rag& rag = piece.rag;
  const double r = cloth.radius;
  rag.name = "drape", rag.radius = r;
  rag.n_columns = rag.n_rows = static_cast<int>(std::lround(test.sample_diameter / (2 * r)));
  piece.rag.mask_radius = test.sample_diameter / 2;
  piece.centre = {0, 0, r};
  rag.mass = test.mass_per_area * 4 * r * r, rag.inertia = 0.4 * rag.mass * r * r;
  rag.bond = cloth.bond, rag.bond_damping = cloth.bond_damping, rag.rotation_friction = cloth.rotation_friction;
  rag.shear_modulus = cloth.shear_modulus;
  if (!start) return piece;
  piece.poses.resize(static_cast<std::size_t>(rag.n_columns) * rag.n_rows);
  for (std::size_t k = 0; k < start->id.size(); ++k) {
    const auto& [w, x, y, z] = start->orientation[k];
    piece.poses[start->id[k]] = {start->position[k] - piece.centre, {w, x, y, z}};
  }
  return piece;
}

/// A sum of plane waves, at most two lengths of the sheet each, along the normal.
void begin_waves(RagSystem& rags, int seed) {
  std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
  const auto draw = [&] { return 2 * pi * static_cast<double>(generator() >> 11) * 0x1p-53; };
  struct Wave {
    double per_column, per_row, phase;
  } waves[n_waves];
  const Rag& rag = rags.rags()[0];
  for (Wave& w : waves) {
    const double a = draw(), b = draw();
    w = {2 * a / rag.n_columns, (2 * b - 2 * pi) / rag.n_rows, draw()};
  }
  for (Tile& tile : rags.tiles())
    for_particles(tile, [&](int k, int i, int j) {
      double sum = 0;
      for (const Wave& w : waves) sum += std::sin(w.per_column * (tile.column + i) + w.per_row * (tile.row + j) + w.phase);
      if (tile.free[k] > 0.5) tile.set_vector(Tile::vx, k, {0, 0, start_speed * std::sqrt(2.0 / n_waves) * sum});
    });
}

/// The table, the cloth on it and what moves it.
class DrapeRun {
 public:
  DrapeRun(const DrapeTest& test, const RagPiece& piece, const DrapeCloth& cloth, double safety)
      : rags_(MPI_COMM_SELF, DemSettings{{}, safety}, {piece}) {
    walls_.add_surface("table", table(test.disc_diameter / 2));
    ContactSettings contacts;
    contacts.restitution = contacts.wall_restitution = cloth.restitution;
    contacts.static_friction = contacts.wall_friction = cloth.static_friction;
    contacts.rolling_friction = cloth.rolling_friction;
    contacts.impact_speed = fastest_impact;
    contacts.skin_over_radius = 0.5;  // never a result, only speed
    rags_.set_contacts(std::make_unique<ContactSolver>(contacts, rags_.rags(), &walls_));
    rags_.set_gravity({0, 0, -standard_gravity});
    const double pin = pin_over_radius * piece.rag.radius;
    rags_.clamp([&](std::int64_t id) {
      const Rag& rag = piece.rag;
      const double x = (2.0 * (id % rag.n_columns) - (rag.n_columns - 1)) * rag.radius;
      const auto row = id / rag.n_columns;
      const double y = (2.0 * row - (rag.n_rows - 1)) * rag.radius;
      return x * x + y * y <= pin * pin;
    });
  }
  RagSystem& rags() { return rags_; }

 private:
  WallSet walls_;
  RagSystem rags_;
};

}  // namespace

DrapeTest drape_test(const TextileTests& tests) {
  return {tests.drape.sample_diameter, tests.drape.disc_diameter, tests.drape.mass_per_area};
}

DrapeCloth drape_cloth(const TextileTests& tests, double radius, const std::array<BondProperties, 2>& bond) {
  return {.radius = radius,
          .bond = bond,
          .bond_damping = tests.bond_damping,
          .rotation_friction = tests.rotation_friction,
          .shear_modulus = tests.shear_modulus,
          .restitution = tests.restitution,
          .static_friction = tests.static_friction,
          .rolling_friction = tests.rolling_friction};
}

Drape relaxed_drape(const DrapeTest& test, const DrapeCloth& cloth, int seed, const RagSheet* start) {
  DrapeRun run(test, relaxing(round_cloth(test, cloth, start)), cloth, 0.9);
  if (!start) begin_waves(run.rags(), seed);
  const double hangs = (test.sample_diameter - test.disc_diameter) / 2;
  Drape drape;
  drape.cost = relax(run.rags(), {.gravity = standard_gravity, .length = hangs, .tolerance = drape_tolerance});
  drape.sheet = gather_sheet(run.rags());
  return drape;
}

Drape moved_drape(const DrapeTest& test, const DrapeCloth& cloth, int seed, double duration, double air, const RagSheet* start) {
  const RagPiece piece = round_cloth(test, cloth, start);
  DrapeRun run(test, piece, cloth, 0.8);
  if (!start) begin_waves(run.rags(), seed);
  run.rags().set_damping_rate(air);
  StillAir slowing(piece.rag, air);
  run.rags().advance(duration, &slowing);
  Drape drape;
  drape.cost = {0, run.rags().time(), run.rags().n_sub_steps()};
  drape.sheet = gather_sheet(run.rags());
  return drape;
}

Coverage seen_from_above(const RagSheet& sheet, double radius, double pixel) {
  return covered_by(sheet.position, std::vector<double>(sheet.position.size(), radius), sheet.triangles, View{}, pixel);
}

Outline outline_from_above(const RagSheet& sheet, double radius) {
  constexpr double pixel = 2e-4;  // m
  return outline(seen_from_above(sheet, radius, pixel), {});
}

}  // namespace snag
