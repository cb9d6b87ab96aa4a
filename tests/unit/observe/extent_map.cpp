// Rags with their centroids in one place.
#include "observe/extent_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace snag;

namespace {

constexpr double pixel = 1e-3;

/// Rectangle of an odd number of pixels, its lower left one at (column, row).
Blob rectangle(int column, int row, int width, int height) {
  Blob blob;
  blob.coverage = Coverage(column * pixel, row * pixel, (column + width - 0.5) * pixel, (row + height - 0.5) * pixel, pixel);
  std::fill(blob.coverage.covered.begin(), blob.coverage.covered.end(), 1);
  blob.seen = moments(blob.coverage);
  return blob;
}

}  // namespace

TEST(ExtentMap, SameRagInManyPlaces) {
  // Requirement: wherever a rag lies, its contours are its own outline.
  ExtentMap map(pixel);
  for (const auto& [column, row] : {std::pair{3, 400}, {-700, 12}, {55, -9}}) map.add(rectangle(column, row, 21, 11));
  for (const double share : {0.1, 1.0}) {
    const Silhouette seen = map.contour(share);
    EXPECT_NEAR(seen.area, 21 * 11 * pixel * pixel, 1e-12);
    EXPECT_NEAR(seen.elongation_ratio, 21.0 / 11, 1e-9);
    EXPECT_NEAR(seen.x, 0, 1e-12);
    EXPECT_NEAR(seen.orientation, 0, 1e-9);
  }
}

TEST(ExtentMap, ContoursOfACross) {
  // Requirement: of one rag lying and three standing, all cover the middle, three quarters the standing one, and together they are a cross.
  ExtentMap map(pixel), standing(pixel);
  map.add(rectangle(0, 0, 31, 11));
  for (int k = 0; k < 3; ++k) standing.add(rectangle(100 * k, 40, 11, 31));
  map.add(standing);
  EXPECT_EQ(map.n_blobs(), 4);
  EXPECT_EQ(map.share(0, 0), 1);
  EXPECT_EQ(map.share(15, 5), 0.25);
  EXPECT_EQ(map.share(-5, -15), 0.75);
  EXPECT_EQ(map.share(15, 15), 0);
  EXPECT_EQ(map.share(1000, 0), 0);
  EXPECT_NEAR(map.contour(0.9).area, 11 * 11 * pixel * pixel, 1e-12);
  EXPECT_NEAR(map.contour(0.7).elongation_ratio, 31.0 / 11, 1e-9);
  EXPECT_NEAR(std::abs(map.contour(0.7).orientation), std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(map.contour(0.1).area, (2 * 31 - 11) * 11 * pixel * pixel, 1e-12);
}
