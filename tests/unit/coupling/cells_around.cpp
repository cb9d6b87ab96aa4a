#include "coupling/cells_around.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/coupling/kernel_box.hpp"

namespace snag {
namespace {

// Requirement: the order of a search names every point once, also one that is not a number, and keeps the points of a small box together.
TEST(OrderInSpace, NamesEveryPointOnce) {
  std::vector<Vec3> points = scattered_points(500);
  points[7].y = std::nan("");
  const double radius = 0.5;  // boxes of 0.2 m hold some twenty of the points
  std::vector<int> order = order_in_space(points, radius);
  double steps = 0, at_random = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (order[i] == 7 || order[i - 1] == 7 || i == 7 || i == 8) continue;
    steps += norm(points[order[i]] - points[order[i - 1]]);
    at_random += norm(points[i] - points[i - 1]);
  }
  EXPECT_LT(steps, 0.3 * at_random);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], static_cast<int>(i));
}

}  // namespace
}  // namespace snag
