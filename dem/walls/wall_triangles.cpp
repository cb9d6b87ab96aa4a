#include "dem/walls/wall_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/parameter.hpp"

namespace snag {

namespace {
constexpr double most_fine_voxels = 8e6;  // 32 MB of starts of lists
}

VoxelGrid::VoxelGrid(const std::vector<WallTriangle>& triangles, double reach, double width, double most_voxels)
    : width_(width), reach_(reach) {
  Vec3 lower{infinity, infinity, infinity}, upper = -lower;
  for (const WallTriangle& t : triangles)
    for (const Vec3& x : t.node)
      for (int d = 0; d < 3; ++d) lower[d] = std::min(lower[d], x[d]), upper[d] = std::max(upper[d], x[d]);
  if (triangles.empty()) return;
  lower -= Vec3{reach, reach, reach}, upper += Vec3{reach, reach, reach};
  const auto count = [&](int d) { return std::floor((upper[d] - lower[d]) / width_) + 1; };
  while (count(0) * count(1) * count(2) > most_voxels) width_ *= 1.1;
  origin_ = lower;
  for (int d = 0; d < 3; ++d) n_[d] = static_cast<int>(count(d));

  std::vector<Hit> hits;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& node = triangles[t].node;
    const Vec3 area = cross(node[1] - node[0], node[2] - node[0]);
    std::array<int, 3> first, n_voxels;  // of the box around the triangle and its reach
    for (int d = 0; d < 3; ++d) {
      const auto [low, high] = std::minmax({node[0][d], node[1][d], node[2][d]});
      const auto place = [&](double x) { return std::clamp(static_cast<int>((x - origin_[d]) / width_), 0, n_[d] - 1); };
      const double margin = reach_ * (1 + 1e-12);
      first[d] = place(low - margin), n_voxels[d] = place(high + margin) - first[d] + 1;
    }
    mark(triangles[t], norm(area) > 0 ? unit(area) : Vec3{}, static_cast<int>(t), first, n_voxels, hits);
  }
  start_.assign(std::size_t(n_[0]) * n_[1] * n_[2] + 1, 0);
  for (const Hit& hit : hits) ++start_[hit.voxel + 1];
  for (std::size_t v = 1; v < start_.size(); ++v) start_[v] += start_[v - 1];
  list_.resize(hits.size());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (const Hit& hit : hits) list_[next[hit.voxel]++] = hit.triangle;  // triangles come in ascending order
}

/// Halves a block of voxels until it is out of reach of the triangle's plane or small; of a small one each voxel is asked.
void VoxelGrid::mark(const WallTriangle& triangle, const Vec3& normal, int index, const std::array<int, 3>& first,
                     const std::array<int, 3>& count, std::vector<Hit>& hits) const {
  constexpr double round_off = 1 + 1e-12;
  constexpr int small = 512;  // voxels
  const auto reach_of_plane = [&](const Vec3& half) {
    return (reach_ + std::abs(normal.x) * half.x + std::abs(normal.y) * half.y + std::abs(normal.z) * half.z) * round_off;
  };
  const auto middle_of = [&](const std::array<int, 3>& corner, const Vec3& half) {
    return origin_ + width_ * Vec3{double(corner[0]), double(corner[1]), double(corner[2])} + half;
  };
  if (std::int64_t{count[0]} * count[1] * count[2] > small) {
    const Vec3 half = 0.5 * width_ * Vec3{double(count[0]), double(count[1]), double(count[2])};
    if (std::abs(dot(middle_of(first, half) - triangle.node[0], normal)) > reach_of_plane(half)) return;
    const int widest = static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
    std::array<int, 3> low = count, high = count, middle = first;
    low[widest] = count[widest] / 2, high[widest] = count[widest] - low[widest], middle[widest] += low[widest];
    mark(triangle, normal, index, first, low, hits);
    mark(triangle, normal, index, middle, high, hits);
    return;
  }
  const Vec3 half = 0.5 * width_ * Vec3{1, 1, 1};
  const double of_plane = reach_of_plane(half), of_sphere = reach_ + norm(half) * round_off;
  for (int k = first[2]; k < first[2] + count[2]; ++k)
    for (int j = first[1]; j < first[1] + count[1]; ++j)
      for (int i = first[0]; i < first[0] + count[0]; ++i) {
        const Vec3 centre = middle_of({i, j, k}, half);
        if (std::abs(dot(centre - triangle.node[0], normal)) > of_plane) continue;
        if (norm_squared(nearest_point(triangle.node, centre).point - centre) > of_sphere * of_sphere) continue;
        hits.push_back({(k * n_[1] + j) * n_[0] + i, index});
      }
}

std::span<const int> VoxelGrid::at(const Vec3& x) const {
  const Vec3 u = (x - origin_) * (1 / width_);
  for (int d = 0; d < 3; ++d)
    if (!(u[d] >= 0 && u[d] < n_[d])) return {};
  const std::size_t v = (std::size_t(u.z) * n_[1] + std::size_t(u.y)) * n_[0] + std::size_t(u.x);
  return {list_.data() + start_[v], list_.data() + start_[v + 1]};
}

TriangleSurface::TriangleSurface(const std::vector<WallTriangle>& triangles, double reach, double far_reach) : TriangleSurface(triangles) {
  fine_ = VoxelGrid(triangles, reach, reach, most_fine_voxels);
  coarse_ = VoxelGrid(triangles, far_reach, 2 * far_reach, most_fine_voxels / 8);
}

TriangleSurface::TriangleSurface(const std::vector<WallTriangle>& triangles) {
  for (const WallTriangle& t : triangles) {
    Vec3 lower = t.node[0], upper = t.node[0];
    for (const Vec3& x : t.node)
      for (int d = 0; d < 3; ++d) lower[d] = std::min(lower[d], x[d]), upper[d] = std::max(upper[d], x[d]);
    const Vec3 normal = -unit(cross(t.node[1] - t.node[0], t.node[2] - t.node[0]));
    triangles_.push_back({t.node, normal, 0.5 * (lower + upper), 0.5 * (upper - lower), t.node_index, {-1, -1, -1}, t.part});
  }
  find_neighbours();
  add_corner_normals();
}

void TriangleSurface::find_neighbours() {
  struct Side {
    int low, high, triangle, place;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int e = 0; e < 3; ++e) {
      const int a = triangles_[t].node_index[e], b = triangles_[t].node_index[(e + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), e});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::array{a.low, a.high, a.triangle, a.place} < std::array{b.low, b.high, b.triangle, b.place};
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i == 2) {
      const Side &a = sides[i], &b = sides[i + 1];
      // Both normals look to the same side if the common edge is run through in opposite directions.
      if (triangles_[a.triangle].node_index[a.place] != triangles_[b.triangle].node_index[b.place])
        triangles_[a.triangle].neighbour[a.place] = b.triangle, triangles_[b.triangle].neighbour[b.place] = a.triangle;
    }
    i = end;
  }
}

void TriangleSurface::add_corner_normals() {
  int n_nodes = 0;
  for (const Triangle& t : triangles_) n_nodes = std::max({n_nodes, t.node_index[0] + 1, t.node_index[1] + 1, t.node_index[2] + 1});
  corner_normal_.assign(n_nodes, {});
  std::vector<char> ends(n_nodes, 0);
  for (const Triangle& t : triangles_)
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = unit(t.node[(i + 1) % 3] - t.node[i]), b = unit(t.node[(i + 2) % 3] - t.node[i]);
      corner_normal_[t.node_index[i]] += std::atan2(norm(cross(a, b)), dot(a, b)) * t.normal;
      if (t.neighbour[i] < 0) ends[t.node_index[i]] = ends[t.node_index[(i + 1) % 3]] = 1;
    }
  for (int i = 0; i < n_nodes; ++i)
    if (ends[i]) corner_normal_[i] = {};
}

TriangleDistance TriangleSurface::distance(int triangle, const Vec3& centre) const {
  const Triangle& t = triangles_[triangle];
  const NearestPoint nearest = nearest_point(t.node, centre);
  if (nearest.feature == TriangleFeature::face) return {dot(centre - t.node[0], t.normal), t.normal, TriangleFeature::face, {-1, -1}};
  Vec3 outlook;  // normal into the fluid of the edge or corner; zero where the surface ends
  std::array<int, 2> node{t.node_index[nearest.place], -1};
  if (nearest.feature == TriangleFeature::edge) {
    node[1] = t.node_index[(nearest.place + 1) % 3];
    if (t.neighbour[nearest.place] >= 0) outlook = t.normal + triangles_[t.neighbour[nearest.place]].normal;
  } else {
    outlook = corner_normal_[node[0]];
  }
  const Vec3 from_wall = centre - nearest.point;
  const double length = norm(from_wall), side = dot(from_wall, outlook) < 0 ? -1 : 1;
  if (length == 0) return {0, norm_squared(outlook) > 0 ? unit(outlook) : t.normal, nearest.feature, node};
  return {side * length, side / length * from_wall, nearest.feature, node};
}

}  // namespace snag
