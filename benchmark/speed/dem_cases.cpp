#include "benchmark/speed/dem_cases.hpp"

#include <cmath>
#include <numbers>

#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "dem/templates/rag_settings.hpp"

namespace snag {

namespace {

constexpr double radius = 1e-3, gravity = 9.81;  // m, m/s2

RagPiece cloth(int n_columns, int n_rows, const Vec3& centre, bool breakage = true) {
  RagSettings settings;
  settings.radius = radius, settings.length = 2 * radius * n_columns, settings.width = 2 * radius * n_rows;
  settings.breakage = breakage;
  settings.position = centre;
  return make_piece(settings, "snag bench dem");
}

DemBenchCase built(MPI_Comm comm, std::vector<RagPiece> pieces, const WallSet& walls, const ContactSettings& contacts) {
  auto own_walls = std::make_unique<WallSet>(walls);
  auto rags = std::make_unique<RagSystem>(comm, DemSettings(), std::move(pieces));
  rags->set_contacts(std::make_unique<ContactSolver>(contacts, rags->rags(), own_walls.get()));
  return {std::move(own_walls), std::move(rags)};
}

}  // namespace

DemBenchCase flat_sheets(MPI_Comm comm, int n_sheets, int n_columns, int n_rows, bool breakage) {
  std::vector<RagPiece> pieces;
  for (int s = 0; s < n_sheets; ++s) pieces.push_back(cloth(n_columns, n_rows, {0, 0, 10 * radius * s}, breakage));
  const Vec3 half{1.1 * radius * n_columns + 0.05, 1.1 * radius * n_rows + 0.05, 0.05};
  WallSet walls;
  walls.add_box("box", -half, half + Vec3{0, 0, 10 * radius * n_sheets});
  DemBenchCase made = built(comm, std::move(pieces), walls, {});
  made.rags->set_gravity({0, 0, -gravity});
  const auto wave = [](double place, double length) { return 2 * std::numbers::pi * place / length; };
  for (Tile& tile : made.rags->tiles())
    for_particles(tile, [&](int k, int column, int row) {
      const double i = tile.column + column, j = tile.row + row;
      tile.set_vector(Tile::vx, k,
                      {0.1 * std::sin(wave(j, 30)), 0.1 * std::cos(wave(i, 30)), 0.5 * std::sin(wave(i, 50)) * std::cos(wave(j, 37))});
    });
  return made;
}

DemBenchCase stacked_sheets(MPI_Comm comm, double speed, double spin) {
  constexpr int n_layers = 4;
  constexpr double layer = 1.99e-3, to_plane = 0.99e-3;  // m
  std::vector<RagPiece> pieces;
  for (int s = 0; s < n_layers; ++s) {
    const Vec3 centre{s % 2 * radius, s % 2 * radius, s * layer};
    pieces.push_back(cloth(75, 55, centre));
    pieces.back().spin = {0, 0, spin};
    pieces.back().velocity = Vec3{speed, 0, 0} + cross(pieces.back().spin, centre);
  }
  WallSet walls;
  walls.add_plane("below", {0, 0, -to_plane}, {0, 0, 1});
  walls.add_plane("above", {0, 0, (n_layers - 1) * layer + to_plane}, {0, 0, -1});
  ContactSettings contacts;
  if (speed != 0 || spin != 0) contacts.wall_friction = 0;
  return built(comm, std::move(pieces), walls, contacts);
}

}  // namespace snag
