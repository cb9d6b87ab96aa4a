#include "casework/outline_moments.hpp"

#include <cmath>
#include <numbers>

#include "dem/particles/tile_particles.hpp"
#include "dem/rag_measures.hpp"

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

std::vector<Vec3> positions(const RagSystem& rags, std::size_t rag) {
  std::vector<Vec3> points;
  for (const Tile& tile : rags.tiles())
    if (tile.rag == static_cast<int>(rag)) for_particles(tile, [&](int k, int, int) { points.push_back(tile.vector(Tile::x, k)); });
  return points;
}

Silhouette seen_cloth(const RagSystem& rags, const View& view) {
  const RagSheet sheet = gather_sheet(rags);
  return silhouette(sheet.position, sheet.triangles, view, 0.5 * rags.rags().front().radius);
}

}  // namespace

Silhouette outline_of(const RagSystem& rags, const View& view) {
  Moments moments;
  for (std::size_t r = 0; r < rags.rags().size(); ++r) {
    const Rag& rag = rags.rags()[r];
    if (rag.n_columns > 1 && rag.n_rows > 1) return seen_cloth(rags, view);
    const std::vector<Vec3> points = positions(rags, r);
    if (points.size() > 1) {
      add_chain(moments, points, rag.radius, rag.hydrodynamic_diameter, view);
    } else if (!points.empty()) {
      const double side = std::sqrt(std::numbers::pi) * rag.radius;  // a square with the area of the disc
      moments.add_rectangle(dot(points[0], view.right), dot(points[0], view.up), 1, 0, side, side);
    }
  }
  return moments.ellipse();
}

}  // namespace snag
