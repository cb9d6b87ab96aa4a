#include "coupling/cell_owner.hpp"

namespace snag {

CellOwner::CellOwner(const Mesh& mesh) : shape_(kernel_shapes().make("cell", "owner of particles")), kernel_(*shape_, 1, mesh) {}

std::vector<int> CellOwner::owner_of(const std::vector<Vec3>& points) {
  kernel_.locate(points);
  return kernel_.holder_rank();
}

}  // namespace snag
