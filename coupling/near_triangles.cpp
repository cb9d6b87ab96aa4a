#include "coupling/near_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/point_tree.hpp"

namespace snag {

NearTriangles::NearTriangles(const std::vector<WallTriangle>& triangles, double reach, double skin)
    : reach_(reach), skin_(skin), surface_(triangles), centroid_(std::make_unique<std::vector<Vec3>>()) {
  for (const WallTriangle& t : triangles) {
    const Vec3 c = (t.node[0] + t.node[1] + t.node[2]) / 3;
    for (const Vec3& node : t.node) largest_radius_ = std::max(largest_radius_, norm(node - c));
    centroid_->push_back(c);
  }
  tree_ = std::make_unique<PointTree>(*centroid_);
}

NearTriangles::~NearTriangles() = default;
NearTriangles::NearTriangles(NearTriangles&&) noexcept = default;

void NearTriangles::around(const Vec3& place, std::vector<int>& candidates) const {
  constexpr std::size_t first_looks = 4;
  std::array<unsigned, first_looks> index{};
  std::array<double, first_looks> distance2{};
  double bound = reach_;
  const std::size_t n = (*tree_)->knnSearch(&place.x, first_looks, index.data(), distance2.data());
  for (std::size_t k = 0; k < n; ++k) bound = std::min(bound, std::abs(surface_.distance(static_cast<int>(index[k]), place).distance));
  const double radius = std::min(bound + 2 * skin_, reach_ + skin_) * (1 + 1e-9), by_centroid = radius + largest_radius_;
  std::vector<std::pair<unsigned, double>> found;
  (*tree_)->radiusSearch(&place.x, by_centroid * by_centroid, found, nanoflann::SearchParams(0, 0, false));
  candidates.clear();
  for (const auto& [triangle, d2] : found)
    if (surface_.within(static_cast<int>(triangle), place, radius)) candidates.push_back(static_cast<int>(triangle));
  std::sort(candidates.begin(), candidates.end());
}

}  // namespace snag
