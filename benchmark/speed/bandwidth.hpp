#pragma once
// Memory bandwidth of the machine as these ranks use it, after McCalpin's STREAM (1995), kernel triad:
//
//   a_i = b_i + s c_i        24 bytes a term: two reads and a write, the read that a write may cause is not counted
//
// The three arrays are each, on all ranks of a node together, four times as large as its last-level caches, so that they come from memory.
#include <mpi.h>

namespace snag {

/// Bytes a second of all ranks together, the best of several passes. Collective.
double triad_bandwidth(MPI_Comm comm);

}  // namespace snag
