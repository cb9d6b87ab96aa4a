#pragma once
// The shaft of an impeller.
#include "base/vec3.hpp"

namespace snag {

struct Shaft {
  Vec3 origin, axis;  // m; unit
  double speed = 0;   // rad/s, right-handed about the axis
};

}  // namespace snag
