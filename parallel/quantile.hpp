#pragma once
// Quantiles of values that are spread over ranks. Only counts travel: the memory does not grow with the number of values.
#include <mpi.h>

#include <vector>

namespace snag {

/// Value below which a share p of the values of all ranks stays, to 1e-12 of their range; the lowest for p = 0, the highest for p = 1, 0
/// without values. The same on any number of ranks. Collective.
double quantile(MPI_Comm comm, std::vector<double> values, double p);

}  // namespace snag
