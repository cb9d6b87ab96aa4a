#pragma once
// The cloth that snag bench dem times: the calibrated cloth of 1 mm particles with damping, rotation friction, contacts and walls, and
// breakage unless said otherwise.
#include <mpi.h>

#include <memory>
#include <string>

#include "dem/rag_system.hpp"
#include "dem/walls/walls.hpp"

namespace snag {

struct DemBenchCase {
  std::unique_ptr<WallSet> walls;
  std::unique_ptr<RagSystem> rags;
};

/// Flat sheets of n_columns x n_rows particles, one above the other at 10 mm, in slow waves (0.1, 0.1 and 0.5 m/s), so that every mode of a
/// bond works, under gravity, in a box that none touches. Nothing is in contact. Collective.
DemBenchCase flat_sheets(MPI_Comm comm, int n_sheets, int n_columns, int n_rows, bool breakage = true);

/// Four layers of 75 x 55 particles in hollow sites, 5.91 contacts a particle, held between two planes. `speed`: of the whole along the
/// planes, m/s; `spin`: about their normal, rad/s; then the planes are smooth. Collective.
DemBenchCase stacked_sheets(MPI_Comm comm, double speed = 0, double spin = 0);

}  // namespace snag
