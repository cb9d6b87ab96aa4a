#pragma once
// Which rank moves a piece of cloth: the one whose cell holds its centre.
#include <vector>

#include "coupling/kernel.hpp"

namespace snag {

class CellOwner {
 public:
  explicit CellOwner(const Mesh& mesh);
  /// The cells have moved.
  void mesh_moved() { kernel_.mesh_moved(); }
  /// Rank whose cell holds each point of this rank (lowest cell_id on a tie); outside all cells that of the nearest cell centre.
  /// Collective.
  std::vector<int> owner_of(const std::vector<Vec3>& points);

 private:
  std::unique_ptr<KernelShape> shape_;
  Kernel kernel_;
};

}  // namespace snag
