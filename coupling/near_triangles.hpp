#pragma once
// Which triangles of a wall hold the nearest point of a place, and of all places about it: candidates for many searches.
//
// Nearest centroids give an upper bound U of the distance. For a place within `skin` of the one asked for, the nearest triangle is no
// further than U + 2 skin from the latter; by its centroid, that plus the largest distance of a node from its centroid.
#include <memory>
#include <vector>

#include "dem/walls/wall_triangles.hpp"

namespace snag {

class PointTree;

class NearTriangles {
 public:
  /// `reach`: distance beyond which nothing is asked for, m; `skin`: how far places may be from the one that candidates were found for, m.
  NearTriangles(const std::vector<WallTriangle>& triangles, double reach, double skin);
  ~NearTriangles();
  NearTriangles(NearTriangles&&) noexcept;

  /// Candidates for all places within skin of `place`, ascending.
  void around(const Vec3& place, std::vector<int>& candidates) const;
  const TriangleSurface& surface() const { return surface_; }
  double skin() const { return skin_; }

 private:
  double reach_, skin_, largest_radius_ = 0;
  TriangleSurface surface_;
  std::unique_ptr<std::vector<Vec3>> centroid_;  // the tree points to it
  std::unique_ptr<PointTree> tree_;
};

}  // namespace snag
