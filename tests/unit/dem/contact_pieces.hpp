#pragma once
// Small sets of particles in tiles for tests of contacts, advanced by contacts and gravity alone (velocity Verlet).
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/rag.hpp"
#include "dem/particles/tile.hpp"

namespace snag::test {

struct Pieces {
  std::vector<Rag> rags;
  std::vector<std::unique_ptr<Tile>> tiles;
  Vec3 gravity;

  static Rag sphere(double radius, double density, double shear_modulus = 1e6, double poisson_ratio = 0.25) {
    Rag rag;
    rag.name = "piece";
    rag.radius = radius;
    rag.mass = density * 4.0 / 3 * std::numbers::pi * radius * radius * radius;
    rag.inertia = 0.4 * rag.mass * radius * radius;
    rag.shear_modulus = shear_modulus;
    rag.poisson_ratio = poisson_ratio;
    rag.n_particles = 1;
    return rag;
  }

  /// A lattice of columns x rows in tiles of at most side x side, placed by position(column, row); bonded like cloth or not at all.
  void add(Rag rag, int columns, int rows, int side, bool bonded, const std::function<Vec3(int, int)>& position) {
    rag.n_columns = columns, rag.n_rows = rows, rag.n_particles = columns * rows;
    for (const Rag& other : rags) rag.first_particle += other.n_columns * other.n_rows;
    rags.push_back(rag);
    for (int row = 0; row < rows; row += side)
      for (int column = 0; column < columns; column += side) {
        auto tile = std::make_unique<Tile>();
        tile->rag = static_cast<int>(rags.size()) - 1, tile->column = column, tile->row = row;
        tile->allocate(std::min(side, columns - column), std::min(side, rows - row));
        for (int j = -1; j <= tile->ny; ++j)
          for (int i = -1; i <= tile->nx; ++i) fill(*tile, i, j, bonded, position);
        tiles.push_back(std::move(tile));
      }
  }
  void add_sphere(const Rag& rag, const Vec3& position, const Vec3& velocity = {}, const Vec3& spin = {}) {
    add(rag, 1, 1, 1, false, [&](int, int) { return position; });
    tiles.back()->set_vector(Tile::vx, tiles.back()->index(0, 0), velocity);
    tiles.back()->set_vector(Tile::wx, tiles.back()->index(0, 0), spin);
  }

  void fill(Tile& tile, int i, int j, bool bonded, const std::function<Vec3(int, int)>& position) const {
    const Rag& rag = rags[tile.rag];
    const int column = tile.column + i, row = tile.row + j, k = tile.index(i, j);
    const bool column_in = column >= 0 && column < rag.n_columns, row_in = row >= 0 && row < rag.n_rows;
    if (!column_in || !row_in) return;
    tile.exists[k] = 1;
    tile.bond_x[k] = bonded && column + 1 < rag.n_columns;
    tile.bond_y[k] = bonded && row + 1 < rag.n_rows;
    tile.set_vector(Tile::x, k, position(column, row));
  }

  std::vector<Tile*> owned() const {
    std::vector<Tile*> all;
    for (const auto& tile : tiles) all.push_back(tile.get());
    return all;
  }
  Vec3 get(int tile, Tile::Field field, int i = 0, int j = 0) const { return tiles[tile]->vector(field, tiles[tile]->index(i, j)); }
  void set(int tile, Tile::Field field, const Vec3& v) { tiles[tile]->set_vector(field, tiles[tile]->index(0, 0), v); }

  void clear_forces() {
    for (const auto& tile : tiles)
      for (int f = Tile::fx; f <= Tile::tz; ++f) std::fill_n(tile->field(f), tile->field_size, 0.0);
  }
  void kick(double step) {
    for (const auto& tile : tiles) {
      const Rag& rag = rags[tile->rag];
      for (int j = 0; j < tile->ny; ++j)
        for (int k = tile->index(0, j); k < tile->index(tile->nx, j); ++k) {
          const Vec3 a = tile->vector(Tile::fx, k) / rag.mass + gravity;
          tile->set_vector(Tile::vx, k, tile->vector(Tile::vx, k) + step * a);
          tile->set_vector(Tile::wx, k, tile->vector(Tile::wx, k) + step / rag.inertia * tile->vector(Tile::tx, k));
        }
    }
  }
  void drift(double step) {
    for (const auto& tile : tiles)
      for (std::size_t k = 0; k < tile->exists.size(); ++k)
        tile->set_vector(Tile::x, static_cast<int>(k),
                         tile->vector(Tile::x, static_cast<int>(k)) + step * tile->vector(Tile::vx, static_cast<int>(k)));
  }
  /// One step of kick, drift, force, kick; forces of the last step are still in the tiles.
  void advance(ContactSolver& contacts, double step) {
    kick(0.5 * step);
    drift(step);
    clear_forces();
    const auto all = owned();
    contacts.add_forces(all, {}, step);
    kick(0.5 * step);
  }
};

}  // namespace snag::test
