#include "dem/templates/rag_copies.hpp"

#include <cstdint>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/random_numbers.hpp"
#include "base/words.hpp"
#include "dem/templates/rag_settings.hpp"

namespace snag {

std::vector<Parameter> RagCopies::parameters() {
  return {
      {.key = "copies", .target = &count, .minimum = 1, .maximum = 1e6, .meaning = "Number of equal pieces of this table."},
      {"copy_step", &step, "m", -infinity, infinity, Basis::assumed, "Vector from the centre of one copy to that of the next."},
      {"copy_interval", &interval, "s", 0, infinity, Basis::assumed, "Time between the insertion of one copy and that of the next."},
      {.key = "copy_poses",
       .target = &poses,
       .minimum = 1,
       .maximum = 1e6,
       .meaning = "Crumpled copies: number of different poses, with seeds that count up from `seed`; the copies take them in turn."},
      setting("release_patch", &release.patch, "Patch of the mesh at which the pieces are put in; centre is then relative to that point."),
      {"release_depth", &release.depth, "m", 0, infinity, Basis::assumed, "Distance of the centre from the patch, into the water."},
      {"release_spread", &release.spread, "1", 0, 1, Basis::assumed,
       "Spread over the patch: 0 all pieces at its middle, 1 anywhere on it; in between: the fraction of the distance from the middle."},
      {.key = "release_seed",
       .target = &release.seed,
       .minimum = 0,
       .meaning = "Seed of the positions on the patch; each seed gives other positions."},
  };
}

std::vector<RagPiece> copies_of(const RagPiece& piece, const RagCopies& copies, const std::string& where) {
  const ReleasePlan& release = copies.release;
  if (release.patch.empty() && (release.depth > 0 || release.spread > 0))
    throw Error(ExitCode::usage, where + ": release_depth and release_spread need release_patch; give it, or remove them");
  if (copies.poses > 1 && !piece.plan.crumpled())
    throw Error(ExitCode::usage, where + ": copy_poses needs pose = \"confined\" or \"hopper\", it is \"" + piece.plan.kind.word() +
                                     "\"; set pose, or remove it");
  if (copies.count > 1 && copies.step == Vec3{} && copies.interval == 0 && release.patch.empty())
    throw Error(ExitCode::usage, where + ": copies = " + std::to_string(copies.count) +
                                     " would all begin at one place; give copy_step, copy_interval or release_patch");
  const double n_particles = double(copies.count) * piece.rag.n_columns * piece.rag.n_rows;
  if (n_particles > most_particles())
    throw Error(ExitCode::usage, where + ": copies = " + std::to_string(copies.count) + " have " + number_text(n_particles) +
                                     " particles, must be at most " + number_text(most_particles()) + " in the " +
                                     number_text(physical_memory() / 1e9) + " GB of this machine; give fewer copies or a larger radius");
  std::vector<RagPiece> all(copies.count, piece);
  for (int k = 0; k < copies.count; ++k) {
    RagPiece& copy = all[k];
    if (copies.count > 1 && !piece.rag.name.empty()) copy.rag.name += " " + std::to_string(k + 1);
    copy.centre += static_cast<double>(k) * copies.step;
    copy.insert_time += k * copies.interval;
    copy.plan.seed += k % copies.poses;
    copy.release = release, copy.release.index = k;
  }
  return all;
}

double release_share(int seed, int index) {
  const std::uint64_t start = static_cast<std::uint64_t>(seed) << 32 | static_cast<std::uint32_t>(index);
  return static_cast<double>(mixed(start) >> 11) * 0x1p-53;
}

}  // namespace snag
