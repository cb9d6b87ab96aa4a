#include "observe/silhouette.hpp"

#include <algorithm>
#include <cmath>

#include "base/parameter.hpp"
#include "observe/cloth_to_rim.hpp"

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

Coverage covered_by(std::span<const Vec3> points, std::span<const double> radius, std::span<const std::array<int, 3>> triangles,
                    const View& view, double pixel) {
  if (points.empty()) return {0, 0, 0, 0, pixel};
  const ClothToRim cloth = cloth_to_rim(points, radius, triangles);
  double low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
  std::vector<std::array<double, 2>> place;
  const auto hold = [&](const std::array<double, 2>& at, double reach) {
    for (int c = 0; c < 2; ++c) low[c] = std::min(low[c], at[c] - reach), high[c] = std::max(high[c], at[c] + reach);
  };
  for (const Vec3& x : cloth.points) {
    place.push_back({dot(x, view.right), dot(x, view.up)});
    hold(place.back(), 0);
  }
  for (const int k : cloth.loose) hold(place[k], radius[k]);
  Coverage picture(low[0], low[1], high[0], high[1], pixel);
  for (const int k : cloth.loose) picture.fill_circle(place[k][0], place[k][1], radius[k]);
  for (const auto& [a, b, c] : cloth.triangles)
    picture.fill_triangle({place[a][0], place[b][0], place[c][0]}, {place[a][1], place[b][1], place[c][1]});
  return picture;
}

Silhouette silhouette(std::span<const Vec3> points, std::span<const double> radius, std::span<const std::array<int, 3>> triangles,
                      const View& view, double pixel) {
  return moments(covered_by(points, radius, triangles, view, pixel));
}

}  // namespace snag
