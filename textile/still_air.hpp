#pragma once
// Air at rest that slows every particle at a given rate, so that a motion comes to rest.
#include "dem/particles/tile_particles.hpp"
#include "dem/rag_system.hpp"

namespace snag {

class StillAir : public TileForce {
 public:
  /// `rate`: 1/s; `before`: a force that acts as well.
  StillAir(const Rag& rag, double rate, TileForce* before = nullptr)
      : of_velocity_(rate * rag.mass), of_spin_(rate * rag.inertia), before_(before) {}
  void add(std::size_t i, Tile& tile, double step) override {
    if (before_) before_->add(i, tile, step);
    for_particles(tile, [&](int k, int, int) {
      tile.set_vector(Tile::fx, k, tile.vector(Tile::fx, k) - of_velocity_ * tile.vector(Tile::vx, k));
      tile.set_vector(Tile::tx, k, tile.vector(Tile::tx, k) - of_spin_ * tile.vector(Tile::wx, k));
    });
  }

 private:
  double of_velocity_, of_spin_;
  TileForce* before_;
};

}  // namespace snag
