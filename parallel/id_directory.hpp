#pragma once
// Finding rows by their id over all ranks. Rank id mod n_ranks knows where the row with that id is: no rank holds a list of all.
#include <mpi.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace snag {

/// Of each wanted row the rank that holds it and its index there.
struct RowPlaces {
  std::vector<int> rank, index;
};

/// Where the rows `wanted` on this rank are, if each rank holds the rows `held`. Collective. Throws Error(io) that begins with `what`
/// if an id is not held, or is held twice.
RowPlaces find_rows(MPI_Comm comm, std::span<const std::int64_t> held, std::span<const std::int64_t> wanted, const std::string& what);

}  // namespace snag
