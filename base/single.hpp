#pragma once
// Vectors in single precision, in half the memory: where values are kept whose rounding goes into no equation.
#include <array>

#include "base/vec3.hpp"

namespace snag {

using SingleVec3 = std::array<float, 3>;

inline SingleVec3 single(const Vec3& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
inline Vec3 wide(const SingleVec3& v) { return {v[0], v[1], v[2]}; }

}  // namespace snag
