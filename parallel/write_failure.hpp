#pragma once
// Failed writes of MPI-IO, kept from HDF5.
//
// HDF5 1.10 does not survive a write that fails (the disk is full): its file stays half closed, and MPI_Finalize crashes in the attempt to
// close it again; a rank that returns early leaves the others waiting. Snag therefore puts itself between HDF5 and MPI, by the profiling
// interface of MPI (MPI_X is defined here and calls PMPI_X): HDF5 is told that all went well, goes the same way on all ranks and closes its
// file, and who wrote asks here what failed.
#include <string>

namespace snag {

/// Why the first write failed on this rank since the last forget_write_failure(); empty: all went well.
const std::string& write_failure();
void forget_write_failure();

}  // namespace snag
