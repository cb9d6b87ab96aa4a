#pragma once
// Many drapes, shared out over the ranks.
#include <mpi.h>

#include <functional>
#include <vector>

#include "textile/drape.hpp"

namespace snag {

/// One laying of the cloth.
struct DrapeSample {
  int seed = 0;
  Outline outline;
  RelaxationCost cost;
};

/// Samples 0 .. n - 1 of `make`, each made by one rank, on all of them. Collective; an error of one rank is thrown on all.
std::vector<DrapeSample> drape_samples(MPI_Comm comm, std::size_t n, const std::function<DrapeSample(std::size_t)>& make);

}  // namespace snag
