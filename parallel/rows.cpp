#include "parallel/rows.hpp"

#include <limits>
#include <numeric>
#include <string>

#include "base/error.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

/// Counted in rows, not in bytes, the sizes of a message stay within MPI's int.
struct RowType {
  MPI_Datatype type = MPI_DATATYPE_NULL;
  explicit RowType(std::size_t row_size) {
    MPI_Type_contiguous(static_cast<int>(row_size), MPI_BYTE, &type);
    MPI_Type_commit(&type);
  }
  ~RowType() { MPI_Type_free(&type); }
  RowType(const RowType&) = delete;
  RowType& operator=(const RowType&) = delete;
};

std::vector<int> starts(const std::vector<int>& counts) {
  std::vector<int> result(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), result.begin(), 0);
  return result;
}

}  // namespace

std::vector<int> row_starts(MPI_Comm comm, std::size_t n_mine) {
  const auto size = static_cast<std::size_t>(size_of(comm));
  const auto mine = static_cast<std::int64_t>(n_mine);
  std::vector<std::int64_t> count(size);
  MPI_Allgather(&mine, 1, MPI_INT64_T, count.data(), 1, MPI_INT64_T, comm);
  const std::int64_t total = std::accumulate(count.begin(), count.end(), std::int64_t{0});
  if (total > std::numeric_limits<int>::max())
    throw Error(ExitCode::io, "gathering rows of all ranks: " + std::to_string(total) +
                                  " are too many, must be below 2^31; coarsen the surface or split the case");
  std::vector<int> start(size + 1, 0);
  for (std::size_t r = 0; r < size; ++r) start[r + 1] = start[r] + static_cast<int>(count[r]);
  return start;
}

void broadcast_bytes(MPI_Comm comm, void* rows, std::size_t n_rows, std::size_t row_size) {
  if (n_rows > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw Error(ExitCode::io, "sending rows to all ranks: " + std::to_string(n_rows) +
                                  " are too many, must be below 2^31; coarsen the mesh or the surface, or split the case");
  const RowType row(row_size);
  MPI_Bcast(rows, static_cast<int>(n_rows), row.type, 0, comm);
}

void gather_bytes(MPI_Comm comm, const void* mine, const std::vector<int>& start, std::size_t row_size, void* all, bool on_all) {
  const RowType row(row_size);
  std::vector<int> count(start.size() - 1);
  for (std::size_t r = 0; r < count.size(); ++r) count[r] = start[r + 1] - start[r];
  const int n_mine = count[static_cast<std::size_t>(rank_of(comm))];
  if (on_all)
    MPI_Allgatherv(mine, n_mine, row.type, all, count.data(), start.data(), row.type, comm);
  else
    MPI_Gatherv(mine, n_mine, row.type, all, count.data(), start.data(), row.type, 0, comm);
}

std::vector<int> exchanged_counts(MPI_Comm comm, const std::vector<int>& n_sent) {
  std::vector<int> n_received(n_sent.size());
  MPI_Alltoall(n_sent.data(), 1, MPI_INT, n_received.data(), 1, MPI_INT, comm);
  return n_received;
}

void exchange_bytes(MPI_Comm comm, const void* sent, const std::vector<int>& n_sent, void* received, const std::vector<int>& n_received,
                    std::size_t row_size) {
  const RowType row(row_size);
  const auto from = starts(n_sent), to = starts(n_received);
  MPI_Alltoallv(sent, n_sent.data(), from.data(), row.type, received, n_received.data(), to.data(), row.type, comm);
}

}  // namespace snag
