#pragma once
// Small pieces of cloth for tests, and forces on their particles.
#include <mpi.h>

#include <functional>

#include "dem/rag_system.hpp"

namespace snag::testing_pieces {

/// Chain or sheet with the properties of the published cloth at 1 mm, centred at the origin, rows along x; undamped.
inline RagPiece cloth(int n_columns, int n_rows) {
  RagPiece piece;
  Rag& rag = piece.rag;
  rag.name = "cloth", rag.n_columns = n_columns, rag.n_rows = n_rows;
  rag.radius = 1e-3, rag.mass = 2.25e-6, rag.inertia = 0.4 * rag.mass * rag.radius * rag.radius;
  rag.hydrodynamic_volume = 0.77e-3 * 4e-6, rag.hydrodynamic_diameter = 2e-3;
  rag.bond = {published_bond(1e-3, 0), published_bond(1e-3, 1)};
  rag.bond_damping = 0, rag.rotation_friction = 0;
  return piece;
}

/// Two particles bonded lengthwise (0) or crosswise (1).
inline RagPiece pair_along(int direction) { return direction == 0 ? cloth(2, 1) : cloth(1, 2); }

/// Calls a function for each particle: (tile, place, id).
class EachParticle : public TileForce {
 public:
  using Action = std::function<void(Tile& tile, int k, std::int64_t id)>;
  EachParticle(const RagSystem& rags, Action action) : rags_(rags), action_(std::move(action)) {}
  void add(std::size_t, Tile& tile, double) override {
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i)
        if (tile.exists[tile.index(i, j)] > 0.5) action_(tile, tile.index(i, j), particle_id(rags_.rags()[tile.rag], tile, i, j));
  }

 private:
  const RagSystem& rags_;
  Action action_;
};

inline void add_to(Tile& tile, Tile::Field field, int k, const Vec3& v) { tile.set_vector(field, k, tile.vector(field, k) + v); }

/// Viscous damping of all motion at `rate` (1/s), for settling to rest.
inline void add_drag(const RagSystem& rags, Tile& tile, int k, double rate) {
  const Rag& rag = rags.rags()[tile.rag];
  add_to(tile, Tile::fx, k, -rate * rag.mass * tile.vector(Tile::vx, k));
  add_to(tile, Tile::tx, k, -rate * rag.inertia * tile.vector(Tile::wx, k));
}

/// Place of particle `id` of a system on one rank: its tile and index.
inline std::pair<Tile*, int> find(RagSystem& rags, std::int64_t id) {
  for (Tile& tile : rags.tiles())
    for (int j = 0; j < tile.ny; ++j)
      for (int i = 0; i < tile.nx; ++i)
        if (particle_id(rags.rags()[tile.rag], tile, i, j) == id) return {&tile, tile.index(i, j)};
  return {nullptr, 0};
}

inline Vec3 position(RagSystem& rags, std::int64_t id) {
  const auto [tile, k] = find(rags, id);
  return tile->vector(Tile::x, k);
}

}  // namespace snag::testing_pieces
