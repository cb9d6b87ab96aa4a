#pragma once
// Where the water comes in and goes out by pressure, seen as discs: a particle is beyond an opening when it is beyond its mean plane and
// within 1.5 radii of its axis.
#include <string>

#include "base/vec3.hpp"

namespace snag {

/// How far from the axis of an opening a particle still goes through it, in radii: a rag on its way out may hang over the rim.
inline constexpr double opening_reach = 1.5;

struct Opening {
  std::string name;
  Vec3 centre, normal;    // m; unit, out of the domain
  double radius = 0;      // m, the one that holds the patch
  bool is_outlet = true;  // false for an inlet: what lies beyond it has not come in

  /// Distance beyond the plane (m, negative in front of it) if x is near the axis, -infinity otherwise.
  double beyond(const Vec3& x) const;
};

}  // namespace snag
