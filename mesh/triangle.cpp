#include "mesh/triangle.hpp"

namespace snag {

NearestPoint nearest_point(const std::array<Vec3, 3>& node, const Vec3& x) {
  const Vec3 &a = node[0], &b = node[1], &c = node[2];
  const Vec3 ab = b - a, ac = c - a, ap = x - a, bp = x - b, cp = x - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {a, TriangleFeature::corner, 0};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {b, TriangleFeature::corner, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, TriangleFeature::edge, 0};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {c, TriangleFeature::corner, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, TriangleFeature::edge, 2};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {b + (d4 - d3) / (d4 - d3 + (d5 - d6)) * (c - b), TriangleFeature::edge, 1};
  const double scale = 1 / (va + vb + vc);
  return {a + vb * scale * ab + vc * scale * ac, TriangleFeature::face, 0};
}

}  // namespace snag
