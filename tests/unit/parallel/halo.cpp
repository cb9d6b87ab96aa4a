// ranks: 1 2 5
// long ranks: 3
#include "parallel/halo.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "parallel/session.hpp"

namespace {

using namespace snag;

/// A ring: rank r owns r entries (rank 0 none) and has the last entry of every other rank that has one as ghost.
struct Ring {
  int rank = rank_of(MPI_COMM_WORLD), size = size_of(MPI_COMM_WORLD);
  std::vector<int> owner_rank, owner_index;
  Ring() {
    for (int r = 1; r < size; ++r)
      if (r != rank) owner_rank.push_back(r), owner_index.push_back(r - 1);
  }
  int n_ghosts() const { return static_cast<int>(owner_rank.size()); }
};

// Ghosts receive all components of the entry they stand for; owned entries stay; a rank may own nothing.
TEST(Halo, ExchangeFillsGhosts) {
  const Ring ring;
  const Halo halo(MPI_COMM_WORLD, ring.rank, ring.owner_rank, ring.owner_index);
  for (int repeat = 0; repeat < 3; ++repeat) {
    std::vector<Vec3> field(static_cast<std::size_t>(ring.rank + ring.n_ghosts()), Vec3{-1, -1, -1});
    for (int i = 0; i < ring.rank; ++i) field[i] = {100.0 * ring.rank + i, 0.5 + repeat, -i - 0.25};
    halo.exchange(field);
    for (int i = 0; i < ring.rank; ++i) EXPECT_EQ(field[i], (Vec3{100.0 * ring.rank + i, 0.5 + repeat, -i - 0.25}));
    for (int g = 0; g < ring.n_ghosts(); ++g) {
      const int r = ring.owner_rank[g], i = ring.owner_index[g];
      EXPECT_EQ(field[ring.rank + g], (Vec3{100.0 * r + i, 0.5 + repeat, -i - 0.25}));
    }
  }
}

// Integers of 64 bits pass unchanged.
TEST(Halo, ExchangeOfIntegers) {
  const Ring ring;
  const Halo halo(MPI_COMM_WORLD, ring.rank, ring.owner_rank, ring.owner_index);
  std::vector<std::int64_t> field(static_cast<std::size_t>(ring.rank + ring.n_ghosts()), -1);
  for (int i = 0; i < ring.rank; ++i) field[i] = (std::int64_t{1} << 60) + 100 * ring.rank + i;
  halo.exchange(std::span(field));
  for (int g = 0; g < ring.n_ghosts(); ++g)
    EXPECT_EQ(field[ring.rank + g], (std::int64_t{1} << 60) + 100 * ring.owner_rank[g] + ring.owner_index[g]);
}

// A field of the wrong size is refused instead of read beyond its end; an empty halo changes nothing.
TEST(Halo, RefusesFieldsOfWrongSize) {
  const Ring ring;
  const Halo halo(MPI_COMM_WORLD, ring.rank, ring.owner_rank, ring.owner_index);
  std::vector<double> field(static_cast<std::size_t>(ring.rank + ring.n_ghosts()) + 1, 3.0);
  EXPECT_THROW(halo.exchange(field), Error);
  EXPECT_NO_THROW(Halo().exchange(field));
  EXPECT_EQ(field[0], 3.0);
}

}  // namespace
