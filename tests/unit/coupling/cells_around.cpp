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

// Requirement: a search finds the cells nearer than the radius, each once, with their distances and weights, for points that share a patch
// or a group and for lone ones, in any order.
TEST(CellsAround, FindsTheCellsOfEachPoint) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, lower, upper, {24, 16, 32});
  const CellLocator locator(mesh);
  std::vector<double> weights(mesh.n_cells);
  for (int c = 0; c < mesh.n_cells; ++c) weights[c] = 1 + 0.01 * c;
  for (const double radius : {0.3 * h, 1.1 * h, 4 * h}) {
    const std::vector<Vec3> points = scattered_points(2000);
    std::vector<Vec3> in_order;
    for (const int b : order_in_space(points, radius)) in_order.push_back(points[b]);
    for (const auto& places : {in_order, std::vector<Vec3>(points.begin(), points.begin() + 50)}) {
      CellsAround cells_around(mesh, locator, weights, radius);
      WeightRows rows;
      rows.clear();
      std::vector<double> weight;
      for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t first = rows.place.size();
        cells_around.append(places, i, rows, weight);
        ASSERT_EQ(weight.size(), rows.place.size() - first);
        std::vector<int> found, expected;
        for (std::size_t s = first; s < rows.place.size(); ++s) {
          const int c = rows.cells()[rows.place[s]];
          found.push_back(c);
          ASSERT_NEAR(rows.weight[s], norm_squared(mesh.cell_centre[c] - places[i]), 1e-15);
          ASSERT_EQ(weight[s - first], weights[c]);
        }
        for (int c = 0; c < mesh.n_cells; ++c)
          if (norm_squared(mesh.cell_centre[c] - places[i]) < radius * radius) expected.push_back(c);
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected) << "radius " << radius << ", point " << i;
        rows.close_row();
      }
    }
  }
}

}  // namespace
}  // namespace snag
