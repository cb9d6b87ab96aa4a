#include "observe/cloth_to_rim.hpp"

#include <algorithm>

namespace snag {

namespace {

using Edge = std::array<int, 2>;  // rising

Edge edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Edges of one triangle only, sorted.
std::vector<Edge> hem_of(std::span<const std::array<int, 3>> triangles) {
  std::vector<Edge> edges, hem;
  for (const auto& [a, b, c] : triangles)
    for (const Edge& one : {edge(a, b), edge(b, c), edge(c, a)}) edges.push_back(one);
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 0; e < edges.size(); ++e)
    if ((e == 0 || edges[e] != edges[e - 1]) && (e + 1 == edges.size() || edges[e] != edges[e + 1])) hem.push_back(edges[e]);
  return hem;
}

}  // namespace

ClothToRim cloth_to_rim(std::span<const Vec3> points, std::span<const double> radius, std::span<const std::array<int, 3>> triangles) {
  ClothToRim cloth{{points.begin(), points.end()}, {triangles.begin(), triangles.end()}, {}};
  std::vector<bool> is_bonded(points.size(), false);
  for (const auto& triangle : triangles)
    for (const int k : triangle) is_bonded[k] = true;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (!is_bonded[k]) cloth.loose.push_back(static_cast<int>(k));

  const std::vector<Edge> hem = hem_of(triangles);
  const auto is_hem = [&](int a, int b) { return std::binary_search(hem.begin(), hem.end(), edge(a, b)); };
  // From particle `inner` over particle k to the rim, m.
  const auto beyond = [&](int k, int inner) {
    const Vec3 along = points[k] - points[inner];
    return norm(along) > 0 ? radius[k] * unit(along) : Vec3{};
  };
  const auto add_quad = [&](int k, const Vec3& x, const Vec3& y, const Vec3& z) {
    const int first = static_cast<int>(cloth.points.size());
    for (const Vec3& corner : {x, y, z}) cloth.points.push_back(corner);
    cloth.triangles.push_back({k, first, first + 1}), cloth.triangles.push_back({k, first + 1, first + 2});
  };
  for (std::size_t t = 0; t + 1 < triangles.size(); ++t) {
    const auto& [a, b, d] = triangles[t];
    const auto& [a2, d2, c] = triangles[t + 1];
    if (a2 != a || d2 != d) continue;
    const std::array<int, 4> corner{a, b, d, c};
    for (std::size_t i = 0; i < 4; ++i) {
      const int k = corner.at(i), next = corner.at((i + 1) % 4), after = corner.at((i + 2) % 4), before = corner.at((i + 3) % 4);
      if (!is_hem(k, next) || !(radius[k] > 0)) continue;
      const Vec3 out = beyond(k, before);
      add_quad(k, points[next], points[next] + beyond(next, after), points[k] + out);
      if (!is_hem(before, k)) continue;
      const Vec3 aside = beyond(k, next);
      add_quad(k, points[k] + out, points[k] + out + aside, points[k] + aside);
    }
    ++t;  // the second of the pair
  }
  return cloth;
}

}  // namespace snag
