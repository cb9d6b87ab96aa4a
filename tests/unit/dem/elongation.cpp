// ranks: 1
// Elongation of pieces that have no shape of their own, anywhere in space.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/rag_measures.hpp"
#include "dem/rag_system.hpp"

namespace snag {
namespace {

double elongation_of(RagSettings::Shape shape, const Vec3& place, double density) {
  RagSettings settings(shape);
  settings.position = place, settings.diameter = 1e-3, settings.density = density;
  const RagSystem rags(MPI_COMM_SELF, {}, {make_piece(settings, "test")});
  return rag_states(rags)[0].elongation_ratio;
}

// Requirement: a point is as long as it is wide, and a straight fibre is infinitely long, wherever they are: what the sums of large numbers
// leave is no shape.
TEST(Elongation, OfAPointAndOfALine) {
  for (const Vec3& place : {Vec3{}, Vec3{0.3, 0.2, 7.1}, Vec3{-123.4, 0.01, 5.6}}) {
    EXPECT_EQ(elongation_of(RagSettings::Shape::particle, place, 1500), 1) << place.x;
    EXPECT_EQ(elongation_of(RagSettings::Shape::fibre, place, 1500), infinity) << place.x;
  }
}

}  // namespace
}  // namespace snag
