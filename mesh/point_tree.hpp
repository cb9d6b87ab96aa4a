#pragma once
// Search tree over points, for nearest neighbours: nanoflann's k-d tree. For .cpp files only, the header is heavy.
#include <cstddef>
#include <vector>

#include "base/vec3.hpp"
#include "nanoflann.hpp"

namespace snag {

class PointTree {
 public:
  /// The first `count` points; the vector must outlive the tree.
  PointTree(const std::vector<Vec3>& points, std::size_t count) : points_{points, count}, tree_(3, points_) {}
  explicit PointTree(const std::vector<Vec3>& points) : PointTree(points, points.size()) {}
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  struct Points {  // what nanoflann reads
    const std::vector<Vec3>& point;
    std::size_t count;
    std::size_t kdtree_get_point_count() const { return count; }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const { return point[i][static_cast<int>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3>;
  /// The library's searches.
  const Tree* operator->() const { return &tree_; }
  /// Numbers of the points, those of a leaf after each other.
  const std::vector<unsigned>& order_of_leaves() const { return tree_.vAcc; }

 private:
  Points points_;
  Tree tree_;
};

}  // namespace snag
