// A tree of boxes round the triangles of the walls: a box farther away than the nearest point found so far is not looked into.
#include "mesh/wall_distance.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "mesh/geometry.hpp"
#include "mesh/triangle.hpp"
#include "mesh/wall_surface.hpp"
#include "parallel/rows.hpp"

namespace snag {

namespace {

constexpr int leaf_size = 4;  // triangles of a box that is not divided
constexpr double far_away = std::numeric_limits<double>::infinity();

double distance_squared(const Vec3& lower, const Vec3& upper, const Vec3& x) {
  double d2 = 0;
  for (int i = 0; i < 3; ++i) {
    const double beyond = std::max({lower[i] - x[i], x[i] - upper[i], 0.0});
    d2 += beyond * beyond;
  }
  return d2;
}

Vec3 centroid(const WallTriangle& t) { return (t.node[0] + t.node[1] + t.node[2]) / 3; }

}  // namespace

WallTree::WallTree(const std::vector<WallTriangle>& triangles) : triangles_(triangles), order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!triangles.empty()) build(0, static_cast<int>(triangles.size()));
}

/// Divided at the median of the centroids along the longest side; returns the place of the box.
int WallTree::build(int first, int end) {
  const int place = static_cast<int>(boxes_.size());
  Box box{{far_away, far_away, far_away}, {-far_away, -far_away, -far_away}, first, end};
  for (int i = first; i < end; ++i)
    for (const Vec3& node : triangles_[order_[i]].node)
      for (int d = 0; d < 3; ++d) box.lower[d] = std::min(box.lower[d], node[d]), box.upper[d] = std::max(box.upper[d], node[d]);
  boxes_.push_back(box);
  if (end - first <= leaf_size) return place;
  const Vec3 size = box.upper - box.lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int middle = (first + end) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    const double x = centroid(triangles_[a])[axis], y = centroid(triangles_[b])[axis];
    return x < y || (x == y && a < b);
  });
  build(first, middle);
  const int right = build(middle, end);
  boxes_[place].right = right;
  return place;
}

WallPoint WallTree::nearest(const Vec3& place, double within) const {
  if (boxes_.empty()) return {far_away, {}};
  const double limit2 = within * within;
  double best2 = limit2;
  Vec3 best;
  std::vector<std::pair<double, int>> open{{0.0, 0}};  // boxes to look into, with the squares of their distances
  while (!open.empty()) {
    const auto [box_distance2, b] = open.back();
    open.pop_back();
    if (box_distance2 >= best2) continue;
    const Box& box = boxes_[b];
    if (box.right == 0) {
      for (int i = box.first; i < box.end; ++i) {
        const Vec3 point = nearest_point(triangles_[order_[i]].node, place).point;
        if (const double d2 = norm_squared(place - point); d2 < best2) best = point, best2 = d2;
      }
      continue;
    }
    const std::pair<double, int> left{distance_squared(boxes_[b + 1].lower, boxes_[b + 1].upper, place), b + 1},
        right{distance_squared(boxes_[box.right].lower, boxes_[box.right].upper, place), box.right};
    open.push_back(std::max(left, right)), open.push_back(std::min(left, right));
  }
  return best2 < limit2 ? WallPoint{std::sqrt(best2), unit(place - best)} : WallPoint{far_away, {}};
}

namespace {

/// Translations from a place to its images across the periods of the mesh, one of each on either side.
std::vector<Vec3> translations_to_images(const Mesh& mesh) {
  std::vector<Vec3> own, periods;
  const auto add = [](std::vector<Vec3>& to, const Vec3& translation) {
    constexpr double alike = 1e-6;
    const auto is_known = [&](const Vec3& one) {
      return std::min(norm(translation - one), norm(translation + one)) < alike * norm(translation);
    };
    if (norm_squared(translation) > 0 && std::none_of(to.begin(), to.end(), is_known)) to.push_back(translation);
  };
  for (int f = 0; f < mesh.first_facet; ++f) add(own, period(mesh, f));
  for (const Vec3& period : gathered(mesh.comm, own)) add(periods, period);
  std::vector<Vec3> translations{{}};
  for (const Vec3& period : periods)
    for (std::size_t i = 0, n = translations.size(); i < n; ++i)
      translations.push_back(translations[i] + period), translations.push_back(translations[i] - period);
  translations.erase(translations.begin());  // from the place to itself
  return translations;
}

}  // namespace

std::vector<WallPoint> wall_distances(const Mesh& mesh, const std::vector<std::string>& walls) {
  const WallSurface surface = wall_surface(mesh, walls);
  const WallTree tree(surface.triangles);
  const std::vector<Vec3> translations = translations_to_images(mesh);
  std::vector<WallPoint> of_cells(static_cast<std::size_t>(mesh.n_all_cells()));
  for (std::size_t c = 0; c < of_cells.size(); ++c) {
    of_cells[c] = tree.nearest(mesh.cell_centre[c]);
    for (const Vec3& translation : translations) {
      const WallPoint seen = tree.nearest(mesh.cell_centre[c] + translation, of_cells[c].distance);
      if (seen.distance < of_cells[c].distance) of_cells[c] = seen;
    }
  }
  return of_cells;
}

}  // namespace snag
