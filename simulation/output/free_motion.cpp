#include "simulation/output/free_motion.hpp"

#include <algorithm>

#include "dem/particles/tile_particles.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

constexpr std::size_t n_numbers = 12;  // of a rag in a state

/// Force of the water on each rag, N.
std::vector<Vec3> forces_on_rags(const RagSystem& rags, const RagForces& forces) {
  std::vector<std::vector<Vec3>> of(rags.rags().size());
  std::size_t b = 0;
  for (const Tile& tile : rags.tiles()) for_particles(tile, [&](int, int, int) { of[tile.rag].push_back(forces.fluid[b++]); });
  std::vector<Vec3> total;
  for (const std::vector<Vec3>& force : of) total.push_back(sum(rags.comm(), std::span<const Vec3>(force)));
  return total;
}

}  // namespace

void FreeMotion::after_step(const RagSystem& rags, const Passage& passage, const RagForces& forces, double time, double dt) {
  if (std::all_of(rags_.begin(), rags_.end(), [](const OfRag& rag) { return rag.is_over; })) return;
  const std::vector<Vec3> force = forces_on_rags(rags, forces);
  for (std::size_t r = 0; r < rags_.size(); ++r) {
    OfRag& rag = rags_[r];
    const RagState& state = passage.states()[r];
    if (rag.is_over || state.n_particles == 0) continue;
    FreeMotionResult& result = rag.result;
    result.duration += dt, result.impulse += dt * force[r];
    // In its first step: from where it was put in.
    result.path += rag.centre ? norm(state.centre - *rag.centre) : dt * norm(state.velocity);
    rag.centre = state.centre;
    const ByRegion<bool>& touched = passage.sightings()[r].touched;
    if (std::any_of(touched.values.begin(), touched.values.end(), [](bool is) { return is; })) result.first_contact = time;
    rag.is_over = result.first_contact || passage.n_out()[r] > 0;
  }
}

std::vector<double> FreeMotion::state() const {
  std::vector<double> state;
  for (const auto& [result, centre, is_over] : rags_) {
    const Vec3 x = centre.value_or(Vec3{}), &J = result.impulse;
    state.insert(state.end(), {result.first_contact ? 1.0 : 0.0, result.first_contact.value_or(0), result.duration, result.path, J.x, J.y,
                               J.z, centre ? 1.0 : 0.0, x.x, x.y, x.z, is_over ? 1.0 : 0.0});
  }
  return state;
}

void FreeMotion::restore(const std::vector<double>& state) {
  for (std::size_t r = 0; r < rags_.size(); ++r) {
    const double* s = state.data() + n_numbers * r;
    FreeMotionResult& result = rags_[r].result;
    if (s[0] != 0) result.first_contact = s[1];
    result.duration = s[2], result.path = s[3], result.impulse = {s[4], s[5], s[6]};
    if (s[7] != 0) rags_[r].centre = Vec3{s[8], s[9], s[10]};
    rags_[r].is_over = s[11] != 0;
  }
}

}  // namespace snag
