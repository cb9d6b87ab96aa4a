#include "observe/silhouette.hpp"

#include <algorithm>
#include <cmath>

#include "base/parameter.hpp"

namespace snag {

Silhouette moments(const Coverage& picture) {
  const double side = picture.side;
  double m00 = 0, m10 = 0, m01 = 0, m20 = 0, m11 = 0, m02 = 0;
  for (int j = 0; j < picture.ny; ++j) {
    for (int i = 0; i < picture.nx; ++i) {
      if (!picture.at(i, j)) continue;
      const double px = (i + 0.5) * side, py = (j + 0.5) * side;
      m00 += 1, m10 += px, m01 += py, m20 += px * px, m11 += px * py, m02 += py * py;
    }
  }
  Silhouette seen;
  if (m00 == 0) return seen;
  const double cx = m10 / m00, cy = m01 / m00;
  // A pixel is a square, not a point: its own second moment side^2/12 belongs to the blob.
  const double own = side * side / 12;
  const double xx = m20 / m00 - cx * cx + own, yy = m02 / m00 - cy * cy + own, xy = m11 / m00 - cx * cy;
  const double middle = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
  seen.area = m00 * side * side;
  seen.x = picture.x0 + cx, seen.y = picture.y0 + cy;
  seen.elongation_ratio = std::sqrt((middle + spread) / (middle - spread));
  seen.orientation = 0.5 * std::atan2(2 * xy, xx - yy);
  return seen;
}

Silhouette silhouette(std::span<const Vec3> points, std::span<const double> radius, std::span<const std::array<int, 3>> triangles,
                      const View& view, double pixel) {
  if (points.empty()) return {};
  double low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
  std::vector<std::array<double, 2>> place;
  for (std::size_t k = 0; k < points.size(); ++k) {
    place.push_back({dot(points[k], view.right), dot(points[k], view.up)});
    for (int c = 0; c < 2; ++c) low[c] = std::min(low[c], place[k][c] - radius[k]), high[c] = std::max(high[c], place[k][c] + radius[k]);
  }
  Coverage picture(low[0], low[1], high[0], high[1], pixel);
  picture.fill_cloth(place, radius, triangles);
  return moments(picture);
}

}  // namespace snag
