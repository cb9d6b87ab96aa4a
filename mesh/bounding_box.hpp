#pragma once
// The box along the axes that just holds the points of all ranks.
#include <span>

#include "mesh/mesh.hpp"

namespace snag {

struct BoundingBox {
  Vec3 lower, upper;  // m
  Vec3 size() const { return upper - lower; }
  double diagonal() const { return norm(size()); }
};

/// At least one rank has a point. Collective.
BoundingBox bounding_box(MPI_Comm comm, std::span<const Vec3> points);
/// Of all nodes.
inline BoundingBox bounding_box(const Mesh& mesh) { return bounding_box(mesh.comm, mesh.node); }

}  // namespace snag
