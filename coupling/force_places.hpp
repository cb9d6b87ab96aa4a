#pragma once
// Where the forces of the particles act on the water. The kernel gives the force of particle b not to its place x_b but about the mean
// place of its weights, x'_b = sum_c w_bc x_c: away from walls nearly the same, at a wall up to 0.8 widths farther in. The exchange
// therefore loses the couple
//
//   L = |sum_b (x'_b - x_b) x J_b|   of   T = sum_b |(x_b - X) x J_b|,   X = sum |J_b| x_b / sum |J_b| of the rag
//
// A rag of one particle has no T: it counts in neither.
#include <span>

#include <mpi.h>

#include "base/vec3.hpp"

namespace snag {

/// Of one step, over all ranks.
struct ForcePlaces {
  double impulse = 0;       // sum |J_b|, N s
  double displacement = 0;  // mean of |x'_b - x_b|, each weighing |J_b|, m
  double couple_lost = 0;   // L, N m s
  double couple = 0;        // T, N m s
  double relative() const { return couple > 0 ? couple_lost / couple : 0; }
};

/// `places` and `mean_places` (x, x', m) and `impulses` (N s) of this rank's particles; `rag_of` of each, below n_rags. Collective.
ForcePlaces force_places(MPI_Comm comm, std::span<const Vec3> places, std::span<const Vec3> mean_places, std::span<const Vec3> impulses,
                         std::span<const int> rag_of, std::size_t n_rags);

}  // namespace snag
