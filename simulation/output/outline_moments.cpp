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

/// Particles and triangles of each piece.
struct Pieces {
  std::vector<std::vector<Vec3>> points;
  std::vector<std::vector<std::array<int, 3>>> triangles;  // indices into the points of the piece
};

Pieces pieces_of(const RagSheet& sheet, std::size_t n_pieces) {
  Pieces pieces{std::vector<std::vector<Vec3>>(n_pieces), std::vector<std::vector<std::array<int, 3>>>(n_pieces)};
  std::vector<int> place;  // of a particle in its piece
  for (std::size_t k = 0; k < sheet.position.size(); ++k) {
    auto& points = pieces.points[sheet.rag[k]];
    place.push_back(static_cast<int>(points.size()));
    points.push_back(sheet.position[k]);
  }
  for (const auto& [a, b, c] : sheet.triangles) pieces.triangles[sheet.rag[a]].push_back({place[a], place[b], place[c]});
  return pieces;
}

/// Of the pieces first to last - 1 together.
Silhouette seen(const Pieces& pieces, const std::vector<Rag>& rags, const View& view, std::size_t first, std::size_t last) {
  std::vector<Vec3> cloth;
  std::vector<double> radius;
  std::vector<std::array<int, 3>> triangles;
  double pixel = infinity;
  for (std::size_t r = first; r < last; ++r) {
    if (!is_cloth(rags[r]) || pieces.points[r].empty()) continue;
    const int offset = static_cast<int>(cloth.size());
    for (const auto& [a, b, c] : pieces.triangles[r]) triangles.push_back({offset + a, offset + b, offset + c});
    cloth.insert(cloth.end(), pieces.points[r].begin(), pieces.points[r].end());
    radius.resize(cloth.size(), rags[r].radius);
    pixel = std::min(pixel, 0.5 * rags[r].radius);
  }
  if (!cloth.empty()) return silhouette(cloth, radius, triangles, view, pixel);
  Moments moments;
  for (std::size_t r = first; r < last; ++r) {
    const std::vector<Vec3>& points = pieces.points[r];
    if (points.size() > 1) {
      add_chain(moments, points, rags[r].radius, rags[r].hydrodynamic_diameter, view);
    } else if (!points.empty()) {
      const double side = std::sqrt(std::numbers::pi) * rags[r].radius;  // a square with the area of the disc
      moments.add_rectangle(dot(points[0], view.right), dot(points[0], view.up), 1, 0, side, side);
    }
  }
  return moments.ellipse();
}

}  // namespace

Silhouette outline_of_all(const RagSheet& sheet, const std::vector<Rag>& rags, const View& view) {
  return seen(pieces_of(sheet, rags.size()), rags, view, 0, rags.size());
}

std::vector<Silhouette> outlines_of_pieces(const RagSheet& sheet, const std::vector<Rag>& rags, const View& view) {
  const Pieces pieces = pieces_of(sheet, rags.size());
  std::vector<Silhouette> outlines;
  for (std::size_t r = 0; r < rags.size(); ++r) outlines.push_back(seen(pieces, rags, view, r, r + 1));
  return outlines;
}

}  // namespace snag
