#pragma once
// Rows of any plain type that travel between ranks: from the first to all, gathered on all, gathered on the first, or each sent to the rank
// it is for.
#include <mpi.h>

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

namespace snag {

/// Where the rows of each rank begin in a list of all ranks' rows in order of ranks, [n_ranks + 1]. Collective. Throws Error(io) if
/// there are 2^31 or more.
std::vector<int> row_starts(MPI_Comm comm, std::size_t n_mine);

/// Without types, for the templates below: rows of `row_size` bytes.
void broadcast_bytes(MPI_Comm comm, void* rows, std::size_t n_rows, std::size_t row_size);
void gather_bytes(MPI_Comm comm, const void* mine, const std::vector<int>& start, std::size_t row_size, void* all, bool on_all);
void exchange_bytes(MPI_Comm comm, const void* sent, const std::vector<int>& n_sent, void* received, const std::vector<int>& n_received,
                    std::size_t row_size);
std::vector<int> exchanged_counts(MPI_Comm comm, const std::vector<int>& n_sent);

/// Rank 0's rows on every rank; all must have room for as many. Collective. Throws Error(io) if there are 2^31 or more.
template <class Row>
void broadcast(MPI_Comm comm, std::span<Row> rows) {
  static_assert(std::is_trivially_copyable_v<Row>);
  broadcast_bytes(comm, rows.data(), rows.size(), sizeof(Row));
}

/// The rows of all ranks in order of ranks, on every rank; `start` of row_starts. Collective.
template <class Row>
std::vector<Row> gathered(MPI_Comm comm, std::span<const Row> mine, const std::vector<int>& start) {
  static_assert(std::is_trivially_copyable_v<Row>);
  std::vector<Row> all(static_cast<std::size_t>(start.back()));
  gather_bytes(comm, mine.data(), start, sizeof(Row), all.data(), true);
  return all;
}
template <class Row>
std::vector<Row> gathered(MPI_Comm comm, const std::vector<Row>& mine) {
  return gathered(comm, std::span<const Row>(mine), row_starts(comm, mine.size()));
}

/// The same on rank 0; the other ranks get none. Collective.
template <class Row>
std::vector<Row> gathered_on_first(MPI_Comm comm, const std::vector<Row>& mine) {
  static_assert(std::is_trivially_copyable_v<Row>);
  const std::vector<int> start = row_starts(comm, mine.size());
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::vector<Row> all(rank == 0 ? static_cast<std::size_t>(start.back()) : 0);
  gather_bytes(comm, mine.data(), start, sizeof(Row), all.data(), false);
  return all;
}

/// Rows in order of the ranks they go to, or came from, and how many of each.
template <class Row>
struct RowsByRank {
  std::vector<Row> rows;
  std::vector<int> counts;  // [n_ranks]
};

/// What the other ranks sent here. Collective.
template <class Row>
RowsByRank<Row> exchanged(MPI_Comm comm, const RowsByRank<Row>& sent) {
  static_assert(std::is_trivially_copyable_v<Row>);
  RowsByRank<Row> received;
  received.counts = exchanged_counts(comm, sent.counts);
  std::size_t n = 0;
  for (const int count : received.counts) n += static_cast<std::size_t>(count);
  received.rows.resize(n);
  exchange_bytes(comm, sent.rows.data(), sent.counts, received.rows.data(), received.counts, sizeof(Row));
  return received;
}

}  // namespace snag
