// ranks: 1 2 5
// long ranks: 3
#include "parallel/sum.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "parallel/session.hpp"

namespace {

using namespace snag;

/// Terms that cancel by 16 orders of magnitude, dealt to the ranks in turn.
std::vector<double> dealt_terms(int rank, int size) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> mine;
  for (int i = 0; i < 30000; ++i) {
    const double large = 1e16 * uniform(random), small = uniform(random);
    for (const double term : {large, small, -large})
      if (static_cast<int>(random() % static_cast<unsigned>(size)) == rank) mine.push_back(term);
  }
  return mine;
}

// The sum is the one of exact arithmetic even where plain addition loses every digit, on any number of ranks.
TEST(Sum, IsExactUnderCancellation) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  long double expected = 0;
  for (int i = 0; i < 30000; ++i) {
    uniform(random);
    expected += uniform(random);
    for (int k = 0; k < 3; ++k) random();
  }
  const auto terms = dealt_terms(rank_of(MPI_COMM_WORLD), size_of(MPI_COMM_WORLD));
  EXPECT_NEAR(sum(MPI_COMM_WORLD, terms), static_cast<double>(expected), 1e-13 * std::abs(static_cast<double>(expected)));
}

// Each component of a vector sum is summed as a scalar.
TEST(Sum, OfVectorsIsByComponent) {
  const int rank = rank_of(MPI_COMM_WORLD), size = size_of(MPI_COMM_WORLD);
  const std::vector<Vec3> terms(static_cast<std::size_t>(rank), Vec3{1e17, 1, -0.1});  // rank 0 has none
  const int n = size * (size - 1) / 2;
  const Vec3 total = sum(MPI_COMM_WORLD, terms);
  EXPECT_EQ(total.x, 1e17 * n);
  EXPECT_EQ(total.y, n);
  EXPECT_DOUBLE_EQ(total.z, -0.1 * n);
}

// Counts are exact beyond 2^53; extremes are over all ranks; a term that is not a number is not hidden.
TEST(Sum, IntegersExtremesAndInfinities) {
  const int rank = rank_of(MPI_COMM_WORLD), size = size_of(MPI_COMM_WORLD);
  EXPECT_EQ(sum(MPI_COMM_WORLD, std::int64_t{9007199254740993}), std::int64_t{9007199254740993} * size);
  EXPECT_EQ(maximum(MPI_COMM_WORLD, rank), size - 1);
  EXPECT_EQ(minimum(MPI_COMM_WORLD, rank), 0);
  EXPECT_FALSE(std::isfinite(sum(MPI_COMM_WORLD, rank == size - 1 ? std::nan("") : 1.0)));
  EXPECT_FALSE(std::isfinite(sum(MPI_COMM_WORLD, rank == 0 ? HUGE_VAL : 1.0)));
}

}  // namespace
