#pragma once
// Distance of points from the nearest triangle of a surface, exact: a tree of boxes around the triangles, searched from the nearer box on.
#include <array>
#include <limits>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

struct WallTriangle;

/// Where the nearest point of a surface is, seen from a place.
struct WallPoint {
  double distance = 0;  // m; infinity where no point counts
  Vec3 away;            // unit, from the nearest point to the place; zero on the surface and where no point counts
};

class WallTree {
 public:
  /// The triangles must outlive the tree.
  explicit WallTree(const std::vector<WallTriangle>& triangles);
  /// The nearest point among those nearer than `within`, m.
  WallPoint nearest(const Vec3& place, double within = std::numeric_limits<double>::infinity()) const;

 private:
  struct Box {
    Vec3 lower, upper;
    int first = 0, end = 0;  // its triangles in order_
    int right = 0;           // second half; the first follows; 0: not divided
  };
  int build(int first, int end);
  const std::vector<WallTriangle>& triangles_;
  std::vector<int> order_;
  std::vector<Box> boxes_;
};

/// Of all cell centres from the named patches as the mesh stands, [n_all_cells]. Walls are seen across periods, one of each on either side.
/// Every rank holds the triangles of all walls meanwhile. Collective.
std::vector<WallPoint> wall_distances(const Mesh& mesh, const std::vector<std::string>& walls);

}  // namespace snag
