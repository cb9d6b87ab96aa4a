#pragma once
// Triangles of one wall in the frame of the wall: nearest points with the side they are seen from, and a search grid that never has to be
// rebuilt.
//
// The nearest point of a triangle lies on its face, an edge or a corner. Whether the centre is in the fluid there follows from the normal
// into the fluid of the face, by the sum of the two normals at an edge, and by the angle-weighted sum at a corner (Baerentzen and Aanaes
// 2005). Edges where the surface ends, or where more than two triangles meet, have no inside: from there a centre always counts as in the
// fluid.
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "mesh/triangle.hpp"
#include "mesh/wall_surface.hpp"

namespace snag {

/// What a centre sees of one triangle.
struct TriangleDistance {
  double distance = 0;  // m, to the nearest point; negative where the centre is beyond the wall
  Vec3 direction;       // unit, from the wall into the fluid, along the line of nearest point and centre
  TriangleFeature feature = TriangleFeature::face;
  std::array<int, 2> node{-1, -1};  // of the edge or corner
};

/// Which triangles may be nearer than `reach` (m) to a point: a grid of voxels, each with its list.
class VoxelGrid {
 public:
  VoxelGrid() = default;
  /// Voxels at least `width` wide (m); wider where there would be more than `most_voxels`.
  VoxelGrid(const std::vector<WallTriangle>& triangles, double reach, double width, double most_voxels);
  /// Triangles, ascending; all that are within reach of x, and some more.
  std::span<const int> at(const Vec3& x) const;

 private:
  struct Hit {
    int voxel, triangle;
  };
  void mark(const WallTriangle& triangle, const Vec3& normal, int index, const std::array<int, 3>& first, const std::array<int, 3>& count,
            std::vector<Hit>& hits) const;

  Vec3 origin_;
  double width_ = 1, reach_ = 0;
  std::array<int, 3> n_{0, 0, 0};
  std::vector<int> start_, list_;
};

class TriangleSurface {
 public:
  TriangleSurface() = default;
  /// Distances only.
  explicit TriangleSurface(const std::vector<WallTriangle>& triangles);
  /// And the search: `reach`: largest distance asked for in near(); `far_reach`: the same of may_be_near(), m.
  TriangleSurface(const std::vector<WallTriangle>& triangles, double reach, double far_reach);

  std::span<const int> near(const Vec3& centre) const { return fine_.at(centre); }
  bool may_be_near(const Vec3& centre) const { return !coarse_.at(centre).empty(); }
  /// False if a triangle is certainly not nearer than `radius` (m) to a centre: by its box and its plane.
  bool within(int triangle, const Vec3& centre, double radius) const {
    const Triangle& t = triangles_[triangle];
    const Vec3 c = centre - t.middle;
    return std::abs(c.x) < t.half.x + radius && std::abs(c.y) < t.half.y + radius && std::abs(c.z) < t.half.z + radius &&
           std::abs(dot(centre - t.node[0], t.normal)) < radius;
  }
  TriangleDistance distance(int triangle, const Vec3& centre) const;
  const std::array<int, 3>& nodes(int triangle) const { return triangles_[triangle].node_index; }
  int part(int triangle) const { return triangles_[triangle].part; }

 private:
  struct Triangle {
    std::array<Vec3, 3> node;
    Vec3 normal;                               // into the fluid
    Vec3 middle, half;                         // of the box around it
    std::array<int, 3> node_index, neighbour;  // neighbour across the edge from node i to the next; -1 none
    int part;
  };
  void find_neighbours();
  void add_corner_normals();

  std::vector<Triangle> triangles_;
  std::vector<Vec3> corner_normal_;  // by node index; zero: the surface ends there
  VoxelGrid fine_, coarse_;
};

}  // namespace snag
