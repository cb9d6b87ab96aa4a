// ranks: 1 2 5
// long ranks: 3
#include "parallel/rows.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <array>
#include <cstdint>
#include <span>

#include "parallel/session.hpp"

namespace {

using namespace snag;

struct Row {
  std::int64_t id;
  std::array<double, 3> place;
  int rank;
};

/// Rank r has r rows: rank 0 none.
std::vector<Row> rows_of(int rank) {
  std::vector<Row> rows;
  for (int i = 0; i < rank; ++i) rows.push_back({10 * rank + i, {1.0 * rank, 2.0 * i, 0.5}, rank});
  return rows;
}

void expect_all_in_order(const std::vector<Row>& all, int n_ranks) {
  std::size_t at = 0;
  for (int rank = 0; rank < n_ranks; ++rank)
    for (const Row& row : rows_of(rank)) {
      ASSERT_LT(at, all.size());
      EXPECT_EQ(all[at].id, row.id);
      EXPECT_EQ(all[at].place, row.place);
      EXPECT_EQ(all[at++].rank, row.rank);
    }
  EXPECT_EQ(at, all.size());
}

// Every rank gets the rows of all ranks in order of ranks, ranks without rows included.
TEST(Rows, AreGatheredInOrderOfRanks) {
  const int size = size_of(MPI_COMM_WORLD), rank = rank_of(MPI_COMM_WORLD);
  expect_all_in_order(gathered(MPI_COMM_WORLD, rows_of(rank)), size);
  const auto start = row_starts(MPI_COMM_WORLD, rows_of(rank).size());
  for (int r = 0; r <= size; ++r) EXPECT_EQ(start[static_cast<std::size_t>(r)], r * (r - 1) / 2);
}

// The first rank gets them all, the others get none.
TEST(Rows, AreGatheredOnTheFirstRankOnly) {
  const int size = size_of(MPI_COMM_WORLD), rank = rank_of(MPI_COMM_WORLD);
  expect_all_in_order(gathered_on_first(MPI_COMM_WORLD, rows_of(rank)), rank == 0 ? size : 0);
}

// Each rank receives exactly what was addressed to it, in order of the senders; a rank may send nothing to some.
TEST(Rows, ReachTheRankTheyAreFor) {
  const int size = size_of(MPI_COMM_WORLD), rank = rank_of(MPI_COMM_WORLD);
  const auto n_rows = [](int from, int to) { return (from + 2 * to) % 3; };
  RowsByRank<Row> sent;
  for (int to = 0; to < size; ++to) {
    sent.counts.push_back(n_rows(rank, to));
    for (int i = 0; i < n_rows(rank, to); ++i) sent.rows.push_back({100 * rank + to, {1.0 * i, 0, 0}, rank});
  }
  const RowsByRank<Row> received = exchanged(MPI_COMM_WORLD, sent);
  std::size_t at = 0;
  for (int from = 0; from < size; ++from) {
    EXPECT_EQ(received.counts[static_cast<std::size_t>(from)], n_rows(from, rank));
    for (int i = 0; i < n_rows(from, rank); ++i) {
      ASSERT_LT(at, received.rows.size());
      EXPECT_EQ(received.rows[at].id, 100 * from + rank);
      EXPECT_EQ(received.rows[at].rank, from);
      EXPECT_DOUBLE_EQ(received.rows[at++].place[0], i);
    }
  }
  EXPECT_EQ(at, received.rows.size());
}

// Every rank gets the rows of the first.
TEST(Rows, OfTheFirstRankComeToAll) {
  std::vector<Row> rows = rank_of(MPI_COMM_WORLD) == 0 ? rows_of(3) : std::vector<Row>(3);
  broadcast<Row>(MPI_COMM_WORLD, rows);
  const std::vector<Row> expected = rows_of(3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].id, expected[i].id);
    EXPECT_EQ(rows[i].place, expected[i].place);
  }
}

// A message is counted in rows: 400 million of 8 bytes have more bytes than an int counts. One rank sends them to no rank, so that their
// memory is not touched.
TEST(Rows, MayHaveMoreBytesThanAnIntCounts) {
  if (size_of(MPI_COMM_WORLD) > 1) GTEST_SKIP() << "3.2 GB on each rank";
  constexpr std::size_t n = 400'000'000, n_bytes = n * sizeof(std::int64_t);
  void* memory = mmap(nullptr, n_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  MPI_Comm strict = MPI_COMM_NULL;
  MPI_Comm_dup(MPI_COMM_WORLD, &strict);
  MPI_Comm_set_errhandler(strict, MPI_ERRORS_ARE_FATAL);
  broadcast(strict, std::span(static_cast<std::int64_t*>(memory), n));
  MPI_Comm_free(&strict);
  munmap(memory, n_bytes);
}

}  // namespace
