#pragma once
// Which cell holds a point: a grid of bins over the owned cells, exact by the signs at the cell's faces.
#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

class CellLocator {
 public:
  explicit CellLocator(const Mesh& mesh);
  /// Owned cell that holds the point, or -1. A point on a face belongs to the cell of the lower cell_id. `hint`: cell to try first, with
  /// its neighbours.
  int find(const Vec3& point, int hint = -1) const;
  /// Owned cells whose centres lie within `radius` of the point, appended to `cells`.
  void within(const Vec3& point, double radius, std::vector<int>& cells) const;
  /// Owned cell whose centre is nearest, or -1 on a rank without cells.
  int nearest(const Vec3& point) const;
  const Vec3& lower() const { return lower_; }  // of the nodes of the owned cells; lower > upper on a rank without cells
  const Vec3& upper() const { return upper_; }

 private:
  const Mesh& mesh_;
  Vec3 lower_, upper_;
  // bins: compressed rows of the cells whose bounding box meets the bin
  std::array<int, 3> n_bins_{};
  Vec3 bin_width_;
  std::vector<int> bin_start_, bin_cell_;
};

}  // namespace snag
