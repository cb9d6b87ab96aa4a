#include "simulation/output/outline_moments.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parameter.hpp"

namespace snag {

namespace {

/// Area and moments about a point, in the plane of the picture.
struct Moments {
  double area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;  // integrals of 1, x, y, x^2, x y, y^2

  /// A rectangle about (cx, cy): `along` in direction (ux, uy), `across` at right angles.
  void add_rectangle(double cx, double cy, double ux, double uy, double along, double across) {
    const double A = along * across, a = A * along * along / 12, b = A * across * across / 12;
    area += A, x += A * cx, y += A * cy;
    xx += A * cx * cx + a * ux * ux + b * uy * uy;
    yy += A * cy * cy + a * uy * uy + b * ux * ux;
    xy += A * cx * cy + (a - b) * ux * uy;
  }
  Silhouette ellipse() const {
    Silhouette seen;
    if (area <= 0) return seen;
    const double cx = x / area, cy = y / area;
    const double sxx = xx / area - cx * cx, syy = yy / area - cy * cy, sxy = xy / area - cx * cy;
    const double middle = (sxx + syy) / 2, spread = std::hypot((sxx - syy) / 2, sxy);
    seen.area = area, seen.x = cx, seen.y = cy;
    seen.elongation_ratio = std::sqrt((middle + spread) / std::max(middle - spread, 1e-12 * middle));
    seen.orientation = 0.5 * std::atan2(2 * sxy, sxx - syy);
    return seen;
  }
};

/// A chain of particles as strips of `width`; the strips at its ends reach over the last particles.
void add_chain(Moments& moments, const std::vector<Vec3>& points, double radius, double width, const View& view) {
  const auto n_strips = static_cast<double>(points.size() - 1);
  // Seen end on, a fibre is a disc: that part of its area is spread over the strips.
  const double end_on = std::numbers::pi / 4 * width / n_strips;
  const Vec3 line_of_sight = cross(view.right, view.up);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 bond = points[i + 1] - points[i], direction = unit(bond);
    const Vec3 first = i == 0 ? points[i] - radius * direction : points[i];
    const Vec3 last = i + 2 == points.size() ? points[i + 1] + radius * direction : points[i + 1];
    const double ax = dot(first, view.right), ay = dot(first, view.up), bx = dot(last, view.right), by = dot(last, view.up);
    const double seen = std::hypot(bx - ax, by - ay), towards = dot(direction, line_of_sight);
    const double length = seen + towards * towards * end_on;
    const double ux = seen > 0 ? (bx - ax) / seen : 1, uy = seen > 0 ? (by - ay) / seen : 0;
    moments.add_rectangle((ax + bx) / 2, (ay + by) / 2, ux, uy, length, width);
  }
}

bool is_cloth(const Rag& rag) { return rag.n_columns > 1 && rag.n_rows > 1; }

}  // namespace

Silhouette outline_of(const RagSheet& sheet, const std::vector<Rag>& rags, const View& view, int rag) {
  const auto is_asked = [rag](int piece) { return rag < 0 || piece == rag; };
  std::vector<std::vector<Vec3>> points(rags.size());  // by piece
  std::vector<Vec3> cloth;
  std::vector<double> radius;
  std::vector<int> place(sheet.position.size(), -1);  // of a particle in `cloth`
  double pixel = infinity;
  for (std::size_t k = 0; k < sheet.position.size(); ++k) {
    const auto piece = static_cast<std::size_t>(sheet.rag[k]);
    if (!is_asked(sheet.rag[k])) continue;
    points[piece].push_back(sheet.position[k]);
    if (!is_cloth(rags[piece])) continue;
    place[k] = static_cast<int>(cloth.size());
    cloth.push_back(sheet.position[k]), radius.push_back(rags[piece].radius);
    pixel = std::min(pixel, 0.5 * rags[piece].radius);
  }
  if (!cloth.empty()) {
    std::vector<std::array<int, 3>> triangles;
    for (const auto& [a, b, c] : sheet.triangles)
      if (place[a] >= 0) triangles.push_back({place[a], place[b], place[c]});
    return silhouette(cloth, radius, triangles, view, pixel);
  }
  Moments moments;
  for (std::size_t r = 0; r < rags.size(); ++r) {
    if (points[r].size() > 1) {
      add_chain(moments, points[r], rags[r].radius, rags[r].hydrodynamic_diameter, view);
    } else if (!points[r].empty()) {
      const double side = std::sqrt(std::numbers::pi) * rags[r].radius;  // a square with the area of the disc
      moments.add_rectangle(dot(points[r][0], view.right), dot(points[r][0], view.up), 1, 0, side, side);
    }
  }
  return moments.ellipse();
}

}  // namespace snag
