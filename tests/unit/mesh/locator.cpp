// ranks: 1 3
// long ranks: 2 5
#include "mesh/locator.hpp"

#include <cstdlib>
#include <random>

#include "check.hpp"
#include "mesh/import/import.hpp"
#include "mesh/sliding/turning_mesh.hpp"
#include "sample.hpp"
#include "sliding_shells.hpp"
#include "tests/sources.hpp"
#include "tests/structured_box.hpp"

namespace {

using namespace snag;

std::int64_t on_all_ranks(std::int64_t count) { return sum(MPI_COMM_WORLD, count); }

/// Every point was found by exactly one rank.
void expect_one_owner_each(std::vector<int> is_found) {
  MPI_Allreduce(MPI_IN_PLACE, is_found.data(), static_cast<int>(is_found.size()), MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_EQ(std::count(is_found.begin(), is_found.end(), 1), static_cast<std::ptrdiff_t>(is_found.size()));
}

/// Points at random in a box, the same on every rank.
std::vector<Vec3> random_points(int n, const Vec3& lower, const Vec3& upper) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const double a = uniform(random), b = uniform(random), c = uniform(random);
    points.push_back({lower.x + a * (upper.x - lower.x), lower.y + b * (upper.y - lower.y), lower.z + c * (upper.z - lower.z)});
  }
  return points;
}

void expect_own_centres(const Mesh& mesh) {
  const CellLocator locator(mesh);
  for (int c = 0; c < mesh.n_cells; ++c) {
    EXPECT_EQ(locator.find(mesh.cell_centre[c]), c);
    EXPECT_EQ(locator.find(mesh.cell_centre[c], mesh.n_cells - 1 - c), c);
    EXPECT_EQ(locator.nearest(mesh.cell_centre[c]), c);
  }
}

// Every cell of every shape is found from its own centre, with any hint; also in the pump.
TEST(Locator, FindsEachCellFromItsCentre) {
  const test::TemporaryFile mixed(test::mixed_units(5), test::Format::ascii22), warped(test::warped_cube(5, 0.2), test::Format::binary41);
  expect_own_centres(import_mesh(mixed.path(), MPI_COMM_WORLD));
  expect_own_centres(import_mesh(warped.path(), MPI_COMM_WORLD));
  expect_own_centres(import_mesh(in_sources("cases/meshes/pump_coarse.msh"), MPI_COMM_WORLD));
}

// A point inside belongs to exactly one cell of one rank, although the faces are warped; and the answer does not depend on the hint.
TEST(Locator, PointsOfWarpedCellsHaveOneCell) {
  const test::TemporaryFile file(test::warped_cube(6, 0.25), test::Format::ascii22);
  const Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD);
  const CellLocator locator(mesh);
  std::vector<double> found(static_cast<std::size_t>(mesh.n_cells), 0);
  const int n_points = 20000;
  int hint = -1;
  std::vector<int> is_found;
  for (const Vec3& point : random_points(n_points, {0, 0, 0}, {1, 1, 1})) {
    const int cell = locator.find(point);
    is_found.push_back(cell >= 0);
    EXPECT_EQ(locator.find(point, hint), cell);
    if (cell >= 0) found[hint = cell] += 1;
  }
  expect_one_owner_each(is_found);
  // the share of the points is the share of the volume: 6 standard deviations of a binomial count
  for (int c = 0; c < mesh.n_cells; ++c)
    EXPECT_NEAR(found[c], n_points * mesh.cell_volume[c], 6 * std::sqrt(n_points * mesh.cell_volume[c]));
}

// Points on faces, edges and corners of a box belong to the cell of the lowest number among those that touch them.
TEST(Locator, SharedPointsBelongToTheLowestNumber) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {4, 4, 8}, {4, 4, 8});
  const CellLocator locator(mesh);
  std::vector<int> is_found;
  for (int k = 0; k <= 16; ++k)
    for (int j = 0; j <= 8; ++j)
      for (int i = 0; i <= 8; ++i) {
        const auto lowest = [](int twice) { return std::max(0, (twice + 1) / 2 - 1); };
        const std::int64_t expected = lowest(i) + 4 * (lowest(j) + 4 * lowest(k));
        const int cell = locator.find({0.5 * i, 0.5 * j, 0.5 * k}, 0);
        is_found.push_back(cell >= 0);
        if (cell >= 0) {
          EXPECT_EQ(mesh.cell_id[cell], expected);
        }
      }
  expect_one_owner_each(is_found);
}

// Points outside have no cell, beyond the box and in the hollow of a mesh that is not convex.
TEST(Locator, PointsOutsideHaveNoCell) {
  const test::TemporaryFile file(test::mixed_units(3), test::Format::ascii22);
  const Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD);
  const CellLocator spread(mesh);
  for (const Vec3 point : {Vec3{0.5, 1, 1.9}, {1.9, 1, 0.5}, {0.5, 1.5, 2.001}, {-1e-12, 1, 0.5}, {std::nan(""), 1, 1}, {1e9, 0, 0}})
    EXPECT_EQ(spread.find(point, 0), -1);
}

// A period belongs to both of its ends: points there are found, inside as without the period.
TEST(Locator, FindsPointsInPeriodicBoxes) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {0, 0, 0}, {3, 1, 6}, {3, 1, 6}, {true, true, true});
  const CellLocator locator(mesh);
  for (int c = 0; c < mesh.n_cells; ++c) EXPECT_EQ(locator.find(mesh.cell_centre[c]), c);
  std::vector<int> is_found;
  for (const Vec3& point : random_points(500, {0, 0, 0}, {3, 1, 6})) {
    const int cell = locator.find(point);
    is_found.push_back(cell >= 0);
    if (cell < 0) continue;
    EXPECT_EQ(mesh.cell_id[cell], static_cast<int>(point.x) + 3 * static_cast<int>(point.z));
  }
  expect_one_owner_each(is_found);
  EXPECT_GE(on_all_ranks(locator.find({3, 0.5, 2.5}) >= 0), 1);
  EXPECT_GE(on_all_ranks(locator.find({0, 0.5, 2.5}) >= 0), 1);
}

// Cells within a radius and the nearest cell are those of a search through all cells; among equals the lowest number is nearest.
TEST(Locator, NeighbourhoodsAgreeWithASearchThroughAllCells) {
  const test::TemporaryFile file(test::warped_cube(7, 0.2), test::Format::ascii22);
  const Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD);
  const CellLocator locator(mesh);
  for (const Vec3& point : random_points(200, {-0.2, -0.2, -0.2}, {1.2, 1.2, 1.2})) {
    std::vector<int> cells, expected;
    locator.within(point, 0.23, cells);
    int nearest = -1;
    for (int c = 0; c < mesh.n_cells; ++c) {
      if (norm(mesh.cell_centre[c] - point) <= 0.23) expected.push_back(c);
      if (nearest < 0 || norm(mesh.cell_centre[c] - point) < norm(mesh.cell_centre[nearest] - point)) nearest = c;
    }
    std::sort(cells.begin(), cells.end());
    EXPECT_EQ(cells, expected);
    EXPECT_EQ(locator.nearest(point), nearest);
  }
  const Mesh box = structured_box(MPI_COMM_SELF, {0, 0, 0}, {4, 4, 4}, {4, 4, 4});
  EXPECT_EQ(box.cell_id[CellLocator(box).nearest({2, 2, 2})], 1 + 4 * (1 + 4 * 1));
}

// In a mesh with a turning zone, at any angle: a point belongs to one cell of one rank, on its side of the surface of revolution that both
// zones share, also in the slivers between that surface and the flat faces of the cells; no answer depends on the hint, nor on the angle at
// which the locator was made.
TEST(Locator, FollowsATurningZone) {
  const test::Shells shells{.origin = {0.1, 0, 0}, .axis = {1, 2, 3}};
  const test::TemporaryFile file(test::sample_of(shells), test::Format::ascii22);
  Mesh mesh = import_mesh(file.path(), MPI_COMM_WORLD);
  TurningMesh turning(mesh, shells.description(), 0.3);
  const CellLocator made_before(mesh);
  const Vec3 n = unit(shells.axis), e1 = unit(cross({1, 0, 0}, n)), e2 = cross(n, e1);
  for (const double angle : {0.3, 0.31, 2.0, -9.0}) {
    turning.turn(angle);
    const CellLocator locator(mesh);
    for (int c = 0; c < mesh.n_cells; ++c) EXPECT_EQ(made_before.find(mesh.cell_centre[c], mesh.n_cells - 1 - c), c);
    std::vector<int> is_found;
    int hint = -1;
    for (const Vec3& u : random_points(20000, {0, 0, 0}, {1, 1, 1})) {
      // Within the inner and outer walls as they are, polygons; every second point near the cylinder of the interface.
      const bool is_near = u.x < 0.5;
      const double r = is_near ? shells.radius * (1 + 0.02 * (4 * u.x - 1)) : shells.inner + 0.001 + 0.045 * (2 * u.x - 1);
      const double z = is_near ? shells.height * u.z : shells.top * u.z;
      if (z > shells.height && r > shells.radius * std::cos(std::numbers::pi / shells.stator[0])) continue;  // beside the lid
      const double theta = 2 * std::numbers::pi * u.y;
      const Vec3 point = shells.origin + r * std::cos(theta) * e1 + r * std::sin(theta) * e2 + z * n;
      const int cell = made_before.find(point);
      EXPECT_EQ(locator.find(point), cell);
      EXPECT_EQ(made_before.find(point, hint), cell);
      is_found.push_back(cell >= 0);
      if (cell < 0) continue;
      hint = cell;
      EXPECT_EQ(mesh.cell_zone[cell] == mesh.turning.zone, r < shells.radius && z < shells.height);
      std::vector<int> around, expected;
      made_before.within(point, 0.01, around);
      for (int c = 0; c < mesh.n_cells; ++c)
        if (norm(mesh.cell_centre[c] - point) < 0.01) expected.push_back(c);
      std::sort(around.begin(), around.end());
      EXPECT_EQ(around, expected);
    }
    // In the slivers of so coarse a ring cells of two ranks may answer; the lower number holds then.
    MPI_Allreduce(MPI_IN_PLACE, is_found.data(), static_cast<int>(is_found.size()), MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_EQ(std::count(is_found.begin(), is_found.end(), 0), 0);
    EXPECT_LT(std::count_if(is_found.begin(), is_found.end(), [](int count) { return count > 1; }),
              0.005 * static_cast<double>(is_found.size()));
  }
}

// In the pump centres that turn with the rotor keep their cell.
TEST(Locator, PointsTurnWithTheRotorOfThePump) {
  Mesh mesh = import_mesh(in_sources("cases/meshes/pump_coarse.msh"), MPI_COMM_WORLD);
  TurningMesh turning(mesh, {});
  const CellLocator locator(mesh);
  const std::vector<Vec3> at_rest = mesh.cell_centre;
  std::int64_t n_turning = 0;
  for (const double angle : {0.1, 1.7, 4.4}) {
    turning.turn(angle);
    for (int c = 0; c < mesh.n_cells; ++c) {
      EXPECT_EQ(locator.find(mesh.cell_centre[c]), c);
      n_turning += norm(mesh.cell_centre[c] - at_rest[c]) > 1e-4;
    }
  }
  EXPECT_GT(on_all_ranks(n_turning), 30000);
}

}  // namespace
