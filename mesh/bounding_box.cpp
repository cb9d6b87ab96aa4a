#include "mesh/bounding_box.hpp"

#include <algorithm>
#include <limits>

namespace snag {

BoundingBox bounding_box(MPI_Comm comm, std::span<const Vec3> points) {
  constexpr double huge = std::numeric_limits<double>::max();
  double corners[6] = {-huge, -huge, -huge, -huge, -huge, -huge};  // upper, -lower
  for (const Vec3& x : points)
    for (int axis = 0; axis < 3; ++axis)
      corners[axis] = std::max(corners[axis], x[axis]), corners[3 + axis] = std::max(corners[3 + axis], -x[axis]);
  MPI_Allreduce(MPI_IN_PLACE, corners, 6, MPI_DOUBLE, MPI_MAX, comm);
  return {.lower = {-corners[3], -corners[4], -corners[5]}, .upper = {corners[0], corners[1], corners[2]}};
}

}  // namespace snag
