// ranks: 1 2
// The box that holds a mesh.
#include "mesh/bounding_box.hpp"

#include <gtest/gtest.h>

#include "parallel/session.hpp"
#include "tests/structured_box.hpp"

using namespace snag;

// The box of a mesh is that of all ranks; a rank without points changes nothing.
TEST(BoundingBox, holds_the_points_of_all_ranks) {
  const BoundingBox whole = bounding_box(structured_box(MPI_COMM_WORLD, {-1, 2, 3}, {4, 3, 3.5}, {6, 2, 2}));
  EXPECT_EQ(whole.lower, (Vec3{-1, 2, 3}));
  EXPECT_EQ(whole.upper, (Vec3{4, 3, 3.5}));
  EXPECT_DOUBLE_EQ(whole.diagonal(), std::sqrt(25 + 1 + 0.25));
  std::vector<Vec3> points;
  if (rank_of(MPI_COMM_WORLD) == 0) points = {{1, 2, 3}};
  EXPECT_EQ(bounding_box(MPI_COMM_WORLD, points).size(), Vec3{});
}
