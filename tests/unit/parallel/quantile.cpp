// ranks: 1 2 3
// Quantiles over ranks.
#include "parallel/quantile.hpp"

#include <gtest/gtest.h>

#include "parallel/session.hpp"

using namespace snag;

// Values 0 .. 999, dealt out to the ranks in turn: quantiles are those of the sorted list, extremes are exact.
TEST(Quantile, is_that_of_the_sorted_values_of_all_ranks) {
  std::vector<double> mine;
  for (int i = rank_of(MPI_COMM_WORLD); i < 1000; i += size_of(MPI_COMM_WORLD)) mine.push_back((i * 7919) % 1000);
  EXPECT_EQ(quantile(MPI_COMM_WORLD, mine, 0), 0);
  EXPECT_NEAR(quantile(MPI_COMM_WORLD, mine, 0.5), 500, 1e-8);
  EXPECT_NEAR(quantile(MPI_COMM_WORLD, mine, 0.99), 990, 1e-8);
  EXPECT_EQ(quantile(MPI_COMM_WORLD, mine, 1), 999);
}

TEST(Quantile, of_no_values_is_zero_and_of_one_is_that_one) {
  EXPECT_EQ(quantile(MPI_COMM_WORLD, {}, 0.5), 0);
  std::vector<double> mine;
  if (rank_of(MPI_COMM_WORLD) == 0) mine.push_back(-3);
  for (const double p : {0.0, 0.5, 1.0}) EXPECT_EQ(quantile(MPI_COMM_WORLD, mine, p), -3);
}
