// ranks: 1 2
#include "mesh/wall_distance.hpp"

#include <gtest/gtest.h>

#include "base/parameter.hpp"
#include "mesh/wall_surface.hpp"
#include "tests/structured_box.hpp"

using namespace snag;

// In a box the distance of a cell is that of the nearest of its walls, on any number of ranks, ghosts too.
TEST(WallDistance, box) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 2, 3}, {5, 7, 9});
  const auto found = wall_distances(mesh, {"x0", "x1", "y0", "z1"});
  ASSERT_EQ(static_cast<int>(found.size()), mesh.n_all_cells());
  for (int c = 0; c < mesh.n_all_cells(); ++c) {
    const Vec3& x = mesh.cell_centre[c];
    EXPECT_NEAR(found[c].distance, std::min({x.x, 1 - x.x, x.y, 3 - x.z}), 1e-12);
    EXPECT_NEAR(norm(found[c].away), 1, 1e-12);
  }
}

// A ridge of the wall just before the end of a period is near to the cells behind it: as in three periods without one. Along z as well.
TEST(WallDistance, across_periods) {
  const auto with_ridge = [](Mesh mesh) {
    for (Vec3& node : mesh.node) {
      const double along = node.x - std::floor(node.x), across = node.z - std::floor(node.z);
      if (node.y < 1e-9) node.y = 0.8 * std::max(0.0, 1 - std::abs(along - 0.9) / 0.1) * std::max(0.0, 1 - std::abs(across - 0.1) / 0.1);
    }
    return mesh;
  };
  const Mesh one = with_ridge(structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {10, 3, 10}, {true, false, true}));
  const Mesh three = with_ridge(structured_box(MPI_COMM_SELF, {-1, 0, -1}, {2, 1, 2}, {30, 3, 30}));
  const WallSurface surface = wall_surface(three, {"y0"});
  const WallTree tree(surface.triangles);
  const auto found = wall_distances(one, {"y0"});
  for (int c = 0; c < one.n_cells; ++c) EXPECT_NEAR(found[c].distance, tree.nearest(one.cell_centre[c]).distance, 1e-12);
}

// Of a triangle the nearest point lies on its face, an edge or a corner; of many triangles, slender ones too, the nearest is found.
TEST(WallDistance, triangles) {
  const WallTriangle one{.node = {Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{0, 1, 0}}, .normal = {0, 0, 1}};
  const std::vector<WallTriangle> single{one};
  const WallTree tree(single);
  EXPECT_NEAR(tree.nearest({0.5, 0.25, -3}).distance, 3, 1e-14);                  // face
  EXPECT_NEAR(tree.nearest({1, -2, 0}).distance, 2, 1e-14);                       // edge
  EXPECT_NEAR(tree.nearest({2, 2, 0}).distance, 4 / std::sqrt(5.0), 1e-14);       // slanting edge
  EXPECT_NEAR(norm(tree.nearest({5, 0, 4}).away - Vec3{0.6, 0, 0.8}), 0, 1e-14);  // corner
  std::vector<WallTriangle> strip;
  for (int i = 0; i < 200; ++i) {
    WallTriangle t = one;
    for (Vec3& node : t.node) node = {10 * node.x, 0.01 * (node.y + i), std::sin(0.1 * i)};
    t.normal = unit(cross(t.node[1] - t.node[0], t.node[2] - t.node[0]));
    strip.push_back(t);
  }
  const WallTree many(strip);
  for (int k = 0; k < 50; ++k) {
    const Vec3 place{0.7 * k - 8, 0.05 * k, 0.3 * std::cos(3.0 * k)};
    double nearest = infinity;
    for (const WallTriangle& t : strip) {
      const std::vector<WallTriangle> each{t};
      nearest = std::min(nearest, WallTree(each).nearest(place).distance);
    }
    EXPECT_DOUBLE_EQ(many.nearest(place).distance, nearest);
  }
}

// Without walls every cell is infinitely far from them.
TEST(WallDistance, no_walls) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {2, 2, 2});
  for (const WallPoint& wall : wall_distances(mesh, {})) EXPECT_EQ(wall.distance, infinity);
}
