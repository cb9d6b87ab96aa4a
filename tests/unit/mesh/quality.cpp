// ranks: 1 3
// long ranks: 2 5
#include "mesh/quality.hpp"

#include <cstdlib>

#include "check.hpp"
#include "mesh/import/import.hpp"
#include "sample.hpp"
#include "tests/sources.hpp"
#include "tests/structured_box.hpp"

namespace {

using namespace snag;

Mesh imported(const test::Sample& sample) {
  const test::TemporaryFile file(sample, test::Format::ascii22);
  return import_mesh(file.path(), MPI_COMM_WORLD);
}

/// One tetrahedron with all its faces named.
test::Sample tetrahedron(const std::vector<Vec3>& nodes) {
  return {nodes,
          {{4, 1, {0, 1, 2, 3}}, {2, 1, {0, 1, 2}}, {2, 1, {0, 1, 3}}, {2, 1, {0, 2, 3}}, {2, 1, {1, 2, 3}}},
          {{1, "fluid"}},
          {{1, "wall"}}};
}

// A box of cubes is perfect in every measure.
TEST(Quality, OfCubesIsOne) {
  const MeshQuality q = quality(structured_box(MPI_COMM_WORLD, {0, 0, 0}, {0.3, 0.4, 0.7}, {3, 4, 7}));
  EXPECT_EQ(q.n_cells, 84);
  EXPECT_EQ(q.n_interior + q.n_boundary, 4 * 4 * 7 + 3 * 5 * 7 + 3 * 4 * 8);
  EXPECT_EQ(q.n_regions, 1);
  EXPECT_NEAR(q.volume, 0.084, 1e-16);
  EXPECT_NEAR(q.min_volume, 1e-3, 1e-17);
  EXPECT_NEAR(q.max_volume, 1e-3, 1e-17);
  EXPECT_NEAR(q.min_quality, 1, 1e-14);
  EXPECT_NEAR(q.mean_quality, 1, 1e-14);
  EXPECT_LT(q.max_non_orthogonality_deg, 1e-5);
  EXPECT_LT(q.max_skewness, 1e-14);
  EXPECT_NEAR(q.min_spacing, 0.1, 1e-15);
  EXPECT_TRUE(q.failures.empty());
}

// A regular tetrahedron has quality 1; the corner of a cube has 3 r_in/R_circ = 3 (1/(3 + sqrt 3)) / (sqrt 3 / 2).
TEST(Quality, OfTetrahedra) {
  const MeshQuality regular = quality(imported(tetrahedron({{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}})));
  EXPECT_NEAR(regular.min_quality, 1, 1e-14);
  const MeshQuality corner = quality(imported(tetrahedron({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})));
  EXPECT_NEAR(corner.min_quality, 3 / (3 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2), 1e-14);
}

// A prism over an isosceles triangle has the sine of its sharpest turn, a pyramid that of its slanted edges; a sheared cube that of its
// angle.
TEST(Quality, OfOtherShapes) {
  const auto only = [](int type, std::vector<int> nodes, std::vector<Vec3> points, const std::vector<std::vector<int>>& faces) {
    test::Sample sample{std::move(points), {{type, 1, std::move(nodes)}}, {{1, "fluid"}}, {{1, "wall"}}};
    for (const auto& face : faces) sample.element.push_back({static_cast<int>(face.size()) - 1, 1, face});
    return quality(imported(sample)).min_quality;
  };
  const double prism = only(6, {0, 1, 2, 3, 4, 5}, {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 1}, {1, 0, 1}, {0, 2, 1}},
                            {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
  EXPECT_NEAR(prism, 1 / std::sqrt(5.0), 1e-14);
  const double pyramid = only(7, {0, 1, 2, 3, 4}, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}},
                              {{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  EXPECT_NEAR(pyramid, 1 / std::sqrt(1.5), 1e-14);
  const double sheared =
      only(5, {0, 1, 2, 3, 4, 5, 6, 7}, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0, 1}, {1.5, 0, 1}, {1.5, 1, 1}, {0.5, 1, 1}},
           {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
  EXPECT_NEAR(sheared, 1 / std::sqrt(1.25), 1e-14);
}

// Meshes of all shapes are judged as one; measures that are zero for cubes are not zero here.
TEST(Quality, MixedMeshIsUsable) {
  const MeshQuality q = quality(imported(test::mixed_units(2)));
  EXPECT_TRUE(q.failures.empty());
  EXPECT_EQ(q.n_regions, 1);
  EXPECT_GT(q.max_non_orthogonality_deg, 1);
  EXPECT_GT(q.max_skewness, 0.01);
}

// Of a plate of one layer the four cells in its corners have two neighbours; of a cube they have three, and there is none.
TEST(Quality, CountsCellsInCorners) {
  const MeshQuality plate = quality(structured_box(MPI_COMM_WORLD, {0, 0, 0}, {0.3, 0.4, 0.1}, {3, 4, 1}));
  EXPECT_EQ(plate.n_corner_cells, 4);
  EXPECT_NEAR(plate.corner_volume, 4e-3, 1e-17);
  EXPECT_EQ(quality(structured_box(MPI_COMM_WORLD, {0, 0, 0}, {0.3, 0.4, 0.3}, {3, 4, 3})).n_corner_cells, 0);
}

// A cube of six pyramids about its middle: the tips of all meet. Those between hexahedra and tetrahedra touch no other pyramid.
TEST(Quality, CountsPyramidsWhoseTipsMeet) {
  test::Sample cube;
  cube.volumes = {{1, "water"}}, cube.surfaces = {{2, "sides"}};
  for (int k = 0; k < 8; ++k) cube.node.push_back({1.0 * (k % 2), 1.0 * (k / 2 % 2), 1.0 * (k / 4)});
  cube.node.push_back({0.5, 0.5, 0.5});
  for (const std::vector<int>& side : {std::vector{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    cube.element.push_back({3, 2, side});
    cube.element.push_back({7, 1, {side[0], side[1], side[2], side[3], 8}});
  }
  const Mesh mesh = imported(cube);
  EXPECT_EQ(quality(mesh).n_meeting_pyramids, 6);
  EXPECT_NE(quality_table(mesh, quality(mesh)).find("pyramids whose tips meet"), std::string::npos);
  EXPECT_EQ(quality(imported(test::mixed_units(2))).n_meeting_pyramids, 0);
}

// A cell turned inside out, and a flat one, are failures that say where they are.
TEST(Quality, ReportsInvertedAndFlatCells) {
  const MeshQuality inverted = quality(imported(tetrahedron({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}})));
  ASSERT_FALSE(inverted.failures.empty());
  EXPECT_NE(inverted.failures[0].find("volume"), std::string::npos);
  EXPECT_NE(inverted.failures[0].find("cell 0 at (0.25, 0.25, 0.25) m"), std::string::npos);
  const MeshQuality flat = quality(imported(tetrahedron({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})));
  EXPECT_FALSE(flat.failures.empty());
  const MeshQuality sliver = quality(imported(tetrahedron({{0, 0, 0}, {0, 1, 1e-3}, {1, 0, 1e-3}, {1, 1, 0}})));
  ASSERT_EQ(sliver.failures.size(), 1U);
  EXPECT_NE(sliver.failures[0].find("at least 0.01"), std::string::npos);
}

// The pump is usable: three regions (rotor, inlet pipe, casing), quality as its maker measured it; the table names zones and patches.
TEST(Quality, OfTheCoarsePump) {
  const Mesh mesh = import_mesh(in_sources("cases/meshes/pump_coarse.msh"), MPI_COMM_WORLD);
  const MeshQuality q = quality(mesh);
  EXPECT_TRUE(q.failures.empty());
  EXPECT_EQ(q.n_regions, 3);
  EXPECT_NEAR(q.min_quality, 0.218, 5e-4);
  EXPECT_NEAR(q.mean_quality, 0.750, 5e-4);
  EXPECT_LT(q.closure, 1e-12);
  const std::string table = quality_table(mesh, q);
  for (const char* word : {"30454", "rotor", "stator", "interface_rotor", "1530 faces", "unconnected regions"})
    EXPECT_NE(table.find(word), std::string::npos) << word;
}

}  // namespace
