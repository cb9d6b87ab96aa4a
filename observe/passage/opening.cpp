#include "observe/passage/opening.hpp"

#include "base/parameter.hpp"

namespace snag {

double Opening::beyond(const Vec3& x) const {
  const Vec3 away = x - centre;
  const double along = dot(away, normal);
  return norm(away - along * normal) < opening_reach * radius ? along : -infinity;
}

}  // namespace snag
