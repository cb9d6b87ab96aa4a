#pragma once
// Vectors of three components and 3 x 3 matrices, SI units, right-handed Cartesian axes.
#include <array>
#include <cmath>

namespace snag {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  constexpr double& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr double operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  constexpr Vec3& operator+=(const Vec3& b) {
    x += b.x, y += b.y, z += b.z;
    return *this;
  }
  constexpr Vec3& operator-=(const Vec3& b) {
    x -= b.x, y -= b.y, z -= b.z;
    return *this;
  }
  constexpr Vec3& operator*=(double s) {
    x *= s, y *= s, z *= s;
    return *this;
  }
  constexpr bool operator==(const Vec3&) const = default;
};
static_assert(sizeof(Vec3) == 3 * sizeof(double), "arrays of Vec3 are sent and stored as arrays of doubles");

constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, double s) { return a *= s; }
constexpr Vec3 operator*(double s, Vec3 a) { return a *= s; }
constexpr Vec3 operator/(Vec3 a, double s) { return a *= 1 / s; }
constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(const Vec3& a, const Vec3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
constexpr double norm_squared(const Vec3& a) { return dot(a, a); }
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// a / |a|, or zero for the zero vector.
inline Vec3 unit(const Vec3& a) {
  const double length = norm(a);
  return length > 0 ? a / length : Vec3{};
}

/// Rows of a 3 x 3 matrix; of a velocity gradient G[i][j] = d u_i / d x_j.
using Mat3 = std::array<Vec3, 3>;
constexpr Vec3 operator*(const Mat3& m, const Vec3& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }
/// v turned by `angle` (rad) about a unit vector, by Rodrigues' formula.
inline Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1 - std::cos(angle)) * dot(axis, v) * axis;
}
/// The matrix that turns any vector so.
inline Mat3 rotation(const Vec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto row = [&](const Vec3& e) { return (1 - c) * dot(axis, e) * axis + c * e + s * cross(e, axis); };
  return {row({1, 0, 0}), row({0, 1, 0}), row({0, 0, 1})};
}

}  // namespace snag
