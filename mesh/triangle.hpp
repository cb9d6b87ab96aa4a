#pragma once
// The nearest point of a triangle, and on which part of it that lies.
#include <array>

#include "base/vec3.hpp"

namespace snag {

enum class TriangleFeature { face, edge, corner };

struct NearestPoint {
  Vec3 point;
  TriangleFeature feature = TriangleFeature::face;
  int place = 0;  // the edge from node `place` to the next, or the corner `place`
};

/// Nearest point of a triangle (Ericson 2005, section 5.1.5).
NearestPoint nearest_point(const std::array<Vec3, 3>& node, const Vec3& x);

}  // namespace snag
