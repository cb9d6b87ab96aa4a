#include "textile/relaxation.hpp"

#include "base/error.hpp"
#include "base/words.hpp"
#include "dem/particles/tile_particles.hpp"

namespace snag {

namespace {

constexpr double relaxing_damping = 0.1;  // c_d: the step stays within a tenth of the undamped one

struct Motion {
  double energy = 0, mass = 0;  // kinetic energy and mass of the free particles, J, kg
};

Motion motion(const RagSystem& rags) {
  Motion sum;
  for (const Tile& tile : rags.tiles()) {
    const Rag& rag = rags.rags()[tile.rag];
    for_particles(tile, [&](int k, int, int) {
      if (tile.free[k] < 0.5) return;
      const Vec3 v = tile.vector(Tile::vx, k), w = tile.vector(Tile::wx, k);
      sum.energy += 0.5 * (rag.mass * dot(v, v) + rag.inertia * dot(w, w));
      sum.mass += rag.mass;
    });
  }
  return sum;
}

void stop(RagSystem& rags) {
  for (Tile& tile : rags.tiles())
    for_particles(tile, [&](int k, int, int) {
      if (tile.free[k] < 0.5) return;
      tile.set_vector(Tile::vx, k, {}), tile.set_vector(Tile::wx, k, {});
    });
}

}  // namespace

RagPiece relaxing(const RagPiece& piece) {
  RagPiece relaxed = piece;
  relaxed.rag.bond_damping = relaxing_damping, relaxed.rag.rotation_friction = 0;
  return relaxed;
}

RelaxationCost relax(RagSystem& rags, const Relaxation& settings, TileForce* force) {
  const double per_mass = settings.gravity * settings.tolerance * settings.tolerance / (2 * settings.length);
  RelaxationCost cost;
  const std::int64_t steps_before = rags.n_sub_steps();
  const double begun = rags.time(), look = settings.steps_between_looks * rags.stable_step();
  double before = 0, peak = 0;
  int quiet_peaks = 0;
  for (;;) {
    rags.advance(look, force);
    const Motion now = motion(rags);
    peak = std::max(peak, now.energy);
    if (now.energy < before) {
      stop(rags);
      ++cost.n_peaks;
      quiet_peaks = peak < per_mass * now.mass ? quiet_peaks + 1 : 0;
      if (quiet_peaks == 2) break;  // one alone may be the ripple of a bond
      peak = 0;
    }
    before = now.energy < before ? 0 : now.energy;
    if (rags.time() - begun > settings.longest_time)
      throw Error(ExitCode::diverged, "relaxation: " + rags.rags()[0].name + " is not at rest after " + number_text(settings.longest_time) +
                                          " s of motion, kinetic energy " + number_text(now.energy) + " J, wanted " +
                                          number_text(per_mass * now.mass) + "; use a larger particle radius or stiffer bonds");
  }
  cost.time = rags.time() - begun, cost.n_steps = rags.n_sub_steps() - steps_before;
  return cost;
}

}  // namespace snag
