#pragma once
// Forces on the particles of the rags, for monitors and pictures.
//
//   fluid     mean over the last step of what the water gives: its impulse over the step. Forces that do not react on the water (weight and
//             buoyancy) are left out
//   contact   sum of the contacts with other particles and walls in the last sub-step
#include <cstdint>
#include <vector>

#include "coupling/coupled_solver.hpp"
#include "dem/rag_system.hpp"

namespace snag {

/// Of this rank's particles, in the order of tiles and for_particles, N.
struct RagForces {
  std::vector<Vec3> fluid, contact;
};
/// `coupled` may be null: no force of the fluid; `step` is the length of its last step, s.
RagForces rag_forces(RagSystem& rags, const CoupledSolver* coupled, double step);

/// Of the magnitudes over the particles of one rag, N; zero if there are none. A share p of them stays below the quantile p.
struct ForceSpread {
  double mean = 0, p50 = 0, p90 = 0, p99 = 0, largest = 0;
};
/// Of each rag: the fluid's over all particles, the contacts' over those that touch something. The same on any number of ranks.
struct RagForceSpread {
  ForceSpread fluid, contact;
  std::int64_t n_in_contact = 0;
};
/// [n_rags], on rank 0 (zeros on the others). Collective.
std::vector<RagForceSpread> force_spreads(const RagSystem& rags, const RagForces& forces);

}  // namespace snag
