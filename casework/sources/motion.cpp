// Motion of the centre of mass of all pieces.
#include "casework/observable_source.hpp"
#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace {

Motion motion_of(const RagSystem& rags) {
  Motion sum;
  double mass = 0;
  for (const Tile& tile : rags.tiles()) {
    const double m = rags.rags()[static_cast<std::size_t>(tile.rag)].mass;
    for_particles(tile, [&](int k, int, int) {
      sum.position += m * tile.vector(Tile::x, k), sum.velocity += m * tile.vector(Tile::vx, k);
      mass += m;
    });
  }
  return {sum.position / mass, sum.velocity / mass};
}

const bool registered =
    add_observable_source<Motion>({.in_memory = [](const RunInMemory& run) -> std::any { return motion_of(*run.simulation.rags); }});

}  // namespace

}  // namespace snag
