// ranks: 1 3
// long ranks: 2 5
#include "tests/structured_box.hpp"

#include "base/error.hpp"
#include "check.hpp"

namespace {

using namespace snag;

// A box has the cells, faces and patches of the formula, closes, fills its volume and points its boundary faces outward.
TEST(StructuredBox, HasTheCountsAndGeometryOfABox) {
  const Vec3 lower{-0.1, 0.2, 0.3}, upper{0.3, 0.5, 1.0};
  const Mesh mesh = structured_box(MPI_COMM_WORLD, lower, upper, {4, 3, 7});
  test::expect_sound(mesh);
  EXPECT_EQ(mesh.n_cells_global, 84);
  EXPECT_EQ(mesh.n_interior_global, 3 * 3 * 7 + 4 * 2 * 7 + 4 * 3 * 6);
  ASSERT_EQ(mesh.patches.size(), 6U);
  EXPECT_EQ(mesh.patches[static_cast<std::size_t>(mesh.patch_index("y1"))].count_global, 28);
  EXPECT_NEAR(test::volume(mesh), 0.4 * 0.3 * 0.7, 1e-15);
  EXPECT_LT(test::closure(mesh), 1e-15);
  const Patch& top = mesh.patches[static_cast<std::size_t>(mesh.patch_index("z1"))];
  for (int f = top.first; f < top.end(); ++f) {
    EXPECT_NEAR(mesh.face_vector[f].z, 0.01, 1e-16);
    EXPECT_NEAR(mesh.face_centre[f].z, 1.0, 1e-15);
    EXPECT_NEAR(mesh.delta[f].z, 0.05, 1e-15);
  }
  for (int f = 0; f < mesh.n_interior; ++f) EXPECT_NEAR(mesh.weight[f], 0.5, 1e-13);
}

// Periodic axes have no patches, their faces join cells one cell width apart, and every cell keeps six faces; also one cell across.
TEST(StructuredBox, PeriodicAxesJoinTheirEnds) {
  for (const std::array<int, 3> n : {std::array{4, 3, 6}, std::array{2, 1, 5}, std::array{3, 3, 1}}) {
    const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {0.1 * n[0], 0.1 * n[1], 0.1 * n[2]}, n, {true, true, true});
    test::expect_sound(mesh);
    EXPECT_TRUE(mesh.patches.empty());
    EXPECT_EQ(mesh.n_faces, mesh.n_interior);
    EXPECT_EQ(mesh.n_interior_global, 3 * mesh.n_cells_global);
    EXPECT_LT(test::closure(mesh), 1e-14);
    for (int c = 0; c < mesh.n_cells; ++c) EXPECT_EQ(mesh.cell_face_start[c + 1] - mesh.cell_face_start[c], 6);
    for (int f = 0; f < mesh.n_faces; ++f) {
      EXPECT_NEAR(norm(mesh.delta[f] - 0.1 * unit(mesh.face_vector[f])), 0, 1e-15);
      EXPECT_NEAR(mesh.weight[f], 0.5, 1e-12);
      const Vec3 half = mesh.face_centre[f] - mesh.cell_centre[mesh.owner[f]];
      EXPECT_NEAR(norm(half - 0.5 * mesh.delta[f]), 0, 1e-15);  // the face lies on the owner's side of the period
    }
  }
}

// More ranks than slabs: ranks without cells take part.
TEST(StructuredBox, RanksMayBeEmpty) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {1, 1, 1}, {3, 2, 2}, {false, false, true});
  test::expect_sound(mesh);
  EXPECT_EQ(mesh.n_cells_global, 12);
  EXPECT_EQ(mesh.patches.size(), 4U);
}

// The global arrays do not depend on the number of ranks.
TEST(StructuredBox, IsTheSameOnAnyNumberOfRanks) {
  const Mesh spread = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {1, 1, 2}, {4, 5, 11}, {true, false, true});
  const Mesh alone = structured_box(MPI_COMM_SELF, {0, 0, 0}, {1, 1, 2}, {4, 5, 11}, {true, false, true});
  const auto a = test::fingerprint(spread), b = test::fingerprint(alone);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12 * std::abs(b[i]));
}

// A box without cells or width is refused with the mesh code.
TEST(StructuredBox, RefusesEmptyAxes) {
  EXPECT_THROW(structured_box(MPI_COMM_WORLD, {0, 0, 0}, {1, 1, 1}, {1, 0, 1}), Error);
  EXPECT_THROW(structured_box(MPI_COMM_WORLD, {0, 0, 0}, {1, 0, 1}, {1, 1, 1}), Error);
}

// An unknown patch is refused with the names that exist.
TEST(Mesh, UnknownPatchListsTheKnownOnes) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {true, true, false});
  try {
    mesh.patch_index("inlet");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::mesh);
    EXPECT_NE(std::string(error.what()).find("z0, z1"), std::string::npos);
  }
}

}  // namespace
