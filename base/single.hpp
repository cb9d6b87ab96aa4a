#pragma once
// Vectors and matrices in single precision, in half the memory: where values are kept whose rounding goes into no equation, or counts
// little in it.
#include <array>

#include "base/vec3.hpp"

namespace snag {

using SingleVec3 = std::array<float, 3>;
using SingleMat3 = std::array<SingleVec3, 3>;

inline SingleVec3 single(const Vec3& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
inline SingleMat3 single(const Mat3& m) { return {single(m[0]), single(m[1]), single(m[2])}; }
inline Vec3 wide(const SingleVec3& v) { return {v[0], v[1], v[2]}; }
inline Mat3 wide(const SingleMat3& m) { return {wide(m[0]), wide(m[1]), wide(m[2])}; }

}  // namespace snag
