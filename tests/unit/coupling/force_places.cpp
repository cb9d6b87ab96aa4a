// ranks: 1 3
// Where the forces of particles act on the water.
#include "coupling/force_places.hpp"

#include <gtest/gtest.h>

#include "coupling/kernel.hpp"
#include "parallel/session.hpp"
#include "tests/structured_box.hpp"

namespace snag {
namespace {

constexpr double delta = 2e-2;  // m

/// Of a row of 2 half + 1 particles along x at the height z over the plane z = 0, 1 N s along `push` on each; on rank 0.
ForcePlaces row_at(double z, const Vec3& push, int half = 2) {
  const Mesh mesh = structured_box(MPI_COMM_WORLD, {-0.2, -0.2, 0}, {0.2, 0.2, 0.4}, {40, 40, 40});  // two cells a width
  const auto shape = kernel_shapes().make("gaussian", "test");
  Kernel kernel(*shape, delta, mesh);
  std::vector<Vec3> places;
  if (rank_of(MPI_COMM_WORLD) == 0)
    for (int i = -half; i <= half; ++i) places.push_back({0.01 * i + 0.001, 0.002, z});
  kernel.locate(places);
  const std::vector<Vec3> impulses(places.size(), push);
  const std::vector<int> rag_of(places.size(), 0);
  return force_places(mesh.comm, places, kernel.average(std::span<const Vec3>(mesh.cell_centre)), impulses, rag_of, 1);
}

// Requirement: two widths and more from walls a force acts within 0.01 widths of its particle; at a wall it acts farther in, and the couple
// lost is the displacement times the force along the wall.
TEST(ForcePlaces, NearAndFarFromAWall) {
  const ForcePlaces open = row_at(0.2, {0, 0, 1});
  EXPECT_DOUBLE_EQ(open.impulse, 5);
  EXPECT_LT(open.displacement, 0.01 * delta);
  EXPECT_LT(open.relative(), 0.01);
  EXPECT_NEAR(open.couple, 0.06, 1e-12) << "0.01 and 0.02 m on both sides of the centre of force";
  EXPECT_LT(row_at(2 * delta, {0, 0, 1}).displacement, 0.2 * delta);
  const ForcePlaces at_wall = row_at(0.001, {1, 0, 0});
  EXPECT_GT(at_wall.displacement, 0.3 * delta);
  EXPECT_NEAR(at_wall.couple_lost, 5 * at_wall.displacement, 0.01 * at_wall.couple_lost);
  EXPECT_NEAR(at_wall.couple, 0, 1e-12) << "all forces are along the row";
}

// Requirement: the force of a single particle has no torque about its centre, and round-off does not pass for one.
TEST(ForcePlaces, OfOneParticle) {
  const ForcePlaces alone = row_at(0.001, {0.3, 0.7, 0.1}, 0);
  EXPECT_GT(alone.displacement, 0.3 * delta);
  EXPECT_EQ(alone.couple, 0);
  EXPECT_EQ(alone.couple_lost, 0);
  EXPECT_EQ(alone.relative(), 0);
}

}  // namespace
}  // namespace snag
