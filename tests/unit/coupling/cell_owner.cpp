// ranks: 1 3
// long ranks: 2 5
#include "coupling/cell_owner.hpp"

#include <gtest/gtest.h>

#include "mesh/locator.hpp"
#include "tests/unit/coupling/kernel_box.hpp"

namespace snag {
namespace {

// Requirement: a point belongs to the rank of its cell; one outside to the rank of the nearest cell; the same answer on every rank.
TEST(CellOwner, FindsTheRankOfTheCell) {
  const Mesh mesh = box(world);
  CellOwner owner(mesh);
  auto points = scattered_points(60);
  points.push_back(upper + Vec3{0.01, 0.02, 0.01});
  const auto found = owner.owner_of(points);
  std::vector<int> of_rank_0 = found;
  MPI_Bcast(of_rank_0.data(), static_cast<int>(of_rank_0.size()), MPI_INT, 0, world);
  EXPECT_EQ(found, of_rank_0);
  const CellLocator locator(mesh);
  for (std::size_t b = 0; b + 1 < points.size(); ++b) {
    EXPECT_EQ(found[b] == rank_of(world), locator.find(points[b]) >= 0);
  }
  EXPECT_EQ(owner.owner_of(points), found) << "hints of the last search must not change the answer";
}

}  // namespace
}  // namespace snag
