#pragma once
// Arrays of vectors and matrices as arrays of their components, which lie one after the other.
#include <span>
#include <vector>

#include "base/vec3.hpp"

namespace snag {

inline std::span<double> flat(std::vector<Vec3>& values) { return {values.empty() ? nullptr : &values[0].x, 3 * values.size()}; }
inline std::span<const double> flat(std::span<const Vec3> values) { return {values.empty() ? nullptr : &values[0].x, 3 * values.size()}; }
inline std::span<double> flat(std::vector<Mat3>& values) { return {values.empty() ? nullptr : &values[0][0].x, 9 * values.size()}; }
inline std::span<const double> flat(std::span<const Mat3> values) {
  return {values.empty() ? nullptr : &values[0][0].x, 9 * values.size()};
}

}  // namespace snag
