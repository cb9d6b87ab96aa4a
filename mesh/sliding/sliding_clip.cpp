// Area and moment from the border, straight pieces a -> b and arcs, about a vertex of the polygon so that nothing large cancels:
//
//   A = sum 1/2 a x b,   M = sum 1/2 a x b (a + b)/3,   an arc of angle d: its chord and the segment behind it,
//   A_seg = R^2/2 (d - sin d),   centroid 2/5 of the sagitta from the chord (exact for a parabola, so to O(d^4))
#include "mesh/sliding/sliding_clip.hpp"

#include <algorithm>
#include <cmath>

namespace snag {
namespace {

/// Collects the border of polygon and circle, walked counter-clockwise.
struct RoundBorder {
  Point2 origin, centre;
  double radius;
  Moments total = {};
  Point2 exit = {}, first_entry = {};  // where the walk left the circle; entered it before it ever left
  bool has_left = false, has_first_entry = false;

  void add_straight(Point2 a, Point2 b) {
    const Point2 p = a - origin, q = b - origin;
    const double area = 0.5 * cross(p, q);
    total.area += area;
    total.first = total.first + area / 3 * (p + q);
  }
  void add_arc(Point2 a, Point2 b) {
    add_straight(a, b);
    const double angle = 2 * std::asin(std::min(1.0, std::sqrt(dot(b - a, b - a)) / (2 * radius)));
    const double area = 0.5 * radius * radius * (angle - std::sin(angle));
    const Point2 chord = 0.5 * (a + b), out = chord - centre;
    const double sagitta = radius * (1 - std::cos(angle / 2)), length = std::sqrt(dot(out, out));
    total.area += area;
    total.first = total.first + area * (chord + 0.4 * sagitta / length * out - origin);
  }
  void enter(Point2 x) {
    if (has_left)
      add_arc(exit, x);
    else
      first_entry = x, has_first_entry = true;
    has_left = false;
  }
  void leave(Point2 x) {
    exit = x;
    has_left = true;
  }
  void finish() {
    if (has_left && has_first_entry) add_arc(exit, first_entry);
    total.first = total.first + total.area * origin;
  }
};

/// Walks an edge a -> b; `a_in`, `b_in`: whether its ends count as inside, decided once for each vertex so that exits and entries
/// alternate.
void walk(RoundBorder& border, Point2 a, Point2 b, bool a_in, bool b_in) {
  if (a_in && b_in) return border.add_straight(a, b);
  const Point2 d = b - a, from_centre = a - border.centre;
  const double A = dot(d, d), B = dot(from_centre, d), C = dot(from_centre, from_centre) - border.radius * border.radius;
  const double discriminant = B * B - A * C;
  const bool misses = A == 0 || discriminant <= 0 || B >= 0 || B <= -A;
  if (!a_in && !b_in && misses) return;
  const double root = std::sqrt(std::max(0.0, discriminant));
  const auto at = [&](double s) { return A > 0 ? a + std::clamp(s / A, 0.0, 1.0) * d : a; };
  const Point2 in = a_in ? a : at(-B - root), out = b_in ? b : at(-B + root);
  if (!a_in) border.enter(in);
  border.add_straight(in, out);
  if (!b_in) border.leave(out);
}

}  // namespace

Polygon intersection(const Polygon& subject, const Polygon& other) {
  std::array<Polygon, 2> pieces;
  const Polygon* result = &subject;
  std::array<double, Polygon::capacity> side;
  for (int e = 0; e < other.n && result->n > 0; ++e) {
    const Point2 p = other[e], along = other.after(e) - p;
    if (along.x == 0 && along.y == 0) continue;
    bool is_cut = false;
    for (int i = 0; i < result->n; ++i) {
      side[static_cast<std::size_t>(i)] = cross(along, (*result)[i] - p);
      is_cut |= side[static_cast<std::size_t>(i)] < 0;
    }
    if (!is_cut) continue;
    Polygon& cut = pieces[result == &pieces[0] ? 1 : 0];
    cut.n = 0;
    for (int i = 0; i < result->n; ++i) {
      const double here = side[static_cast<std::size_t>(i)], next = side[static_cast<std::size_t>(i + 1 < result->n ? i + 1 : 0)];
      if (here >= 0) cut.add((*result)[i]);
      if ((here >= 0) != (next >= 0)) cut.add((*result)[i] + here / (here - next) * (result->after(i) - (*result)[i]));
    }
    result = &cut;
  }
  return *result;
}

Moments moments(const Polygon& polygon) {
  Moments total;
  for (int i = 1; i + 1 < polygon.n; ++i) {
    const Point2 p = polygon[i] - polygon[0], q = polygon[i + 1] - polygon[0];
    const double area = 0.5 * cross(p, q);
    total.area += area;
    total.first = total.first + area * (polygon[0] + 1.0 / 3 * (p + q));
  }
  return total;
}

Point2 middle(const Polygon& polygon) {
  double total = 0;
  Point2 offset{}, mean{};
  for (int i = 0; i < polygon.n; ++i) {
    const Point2 p = polygon[i] - polygon[0], q = polygon.after(i) - polygon[0];
    const double area = std::max(0.0, cross(p, q));
    total += area;
    offset = offset + area / 3 * (p + q);
    mean = mean + 1.0 / polygon.n * p;
  }
  return polygon[0] + (total > 0 ? 1 / total * offset : mean);
}

bool is_convex(const Polygon& polygon) {
  for (int i = 0; i < polygon.n; ++i) {
    const Point2 p = polygon.after(i) - polygon[i], q = polygon.after(i + 1 < polygon.n ? i + 1 : 0) - polygon.after(i);
    if (cross(p, q) < -1e-9 * std::sqrt(dot(p, p) * dot(q, q))) return false;
  }
  return true;
}

Moments moments_inside(const Polygon& polygon, Point2 centre, double radius) {
  if (polygon.n == 0) return {};
  RoundBorder border{polygon[0], centre, radius};
  std::array<bool, Polygon::capacity> inside{};
  for (int i = 0; i < polygon.n; ++i)
    inside[static_cast<std::size_t>(i)] = dot(polygon[i] - centre, polygon[i] - centre) <= radius * radius;
  for (int i = 0; i < polygon.n; ++i)
    walk(border, polygon[i], polygon.after(i), inside[static_cast<std::size_t>(i)],
         inside[static_cast<std::size_t>(i + 1 < polygon.n ? i + 1 : 0)]);
  border.finish();
  return border.total;
}

}  // namespace snag
