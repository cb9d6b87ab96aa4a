#pragma once
// Intersections of faces in the plane of an interface part: convex polygons, and circles at the rims of discs.
#include <array>
#include <cstddef>

namespace snag {

/// Without a first value: a polygon has room for many.
struct Point2 {
  double x, y;
};
constexpr Point2 operator+(Point2 a, Point2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Point2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Point2 operator*(double s, Point2 a) { return {s * a.x, s * a.y}; }
constexpr double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }

/// Convex, counter-clockwise; vertices may coincide. A face has at most 4 nodes and 4 corners of tangents; each of the 8 edges of another
/// adds one vertex to it, two where round-off makes a straight row of vertices cross twice.
struct Polygon {
  static constexpr int capacity = 24;
  int n = 0;
  std::array<Point2, capacity> point;
  Polygon() {}
  Polygon(const Polygon& other) { *this = other; }
  /// Only the places that are in use.
  Polygon& operator=(const Polygon& other) {
    n = other.n;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) point[i] = other.point[i];
    return *this;
  }
  void add(Point2 x) { point[static_cast<std::size_t>(n++)] = x; }
  const Point2& operator[](int i) const { return point[static_cast<std::size_t>(i)]; }
  const Point2& after(int i) const { return point[static_cast<std::size_t>(i + 1 < n ? i + 1 : 0)]; }
};

/// Area and first moment of a piece of the plane, in the unit of the coordinates.
struct Moments {
  double area = 0;
  Point2 first{};
};

/// The part of `subject` left of all edges of `other` (Sutherland and Hodgman 1974). A wrong side by round-off changes areas by round-off.
Polygon intersection(const Polygon& subject, const Polygon& other);
Moments moments(const Polygon& polygon);
/// Mean point of a convex polygon, inside it also when the area is nothing but round-off.
Point2 middle(const Polygon& polygon);
/// True if no vertex turns to the right by more than round-off.
bool is_convex(const Polygon& polygon);
/// Of the part inside a circle; no edge of that part spans half the circle or more.
Moments moments_inside(const Polygon& polygon, Point2 centre, double radius);

}  // namespace snag
