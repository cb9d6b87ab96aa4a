#pragma once
// Which cell holds a point: a grid of bins over the owned cells, exact by the signs at the cell's faces.
#include <array>
#include <memory>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

class CellLocator {
 public:
  explicit CellLocator(const Mesh& mesh);
  ~CellLocator();
  /// Owned cell that holds the point, or -1. A point on a face belongs to the cell of the lower cell_id. `hint`: cell to try first, with
  /// its neighbours. Both sides of a face compute the same sign, so that no point inside a face falls between two cells or two ranks. On an
  /// edge between ranks more than one rank may answer (take the lowest cell_id), and within round-off of an edge none may (take `nearest`).
  int find(const Vec3& point, int hint = -1) const;
  /// Owned cells whose centres lie within `radius` of the point, appended to `cells`.
  void within(const Vec3& point, double radius, std::vector<int>& cells) const;
  /// Owned cell whose centre is nearest (of equally near ones the lowest cell_id), or -1 on a rank without cells.
  int nearest(const Vec3& point) const;
  const Vec3& lower() const { return lower_; }  // of the nodes of the owned cells; lower > upper on a rank without cells
  const Vec3& upper() const { return upper_; }

 private:
  struct CentreTree;  // k-d tree of the cell centres
  enum class Side { outside, on_face, inside };
  double distance_sign(int face, const Vec3& point) const;
  Side side_of(int cell, const Vec3& point) const;
  int bin_along(int axis, double coordinate) const;
  void fill_bins();

  const Mesh& mesh_;
  std::unique_ptr<CentreTree> centres_;
  Vec3 lower_, upper_;
  // bins: compressed rows of the cells whose bounding box meets the bin
  std::array<int, 3> n_bins_{};
  Vec3 bin_width_;
  std::vector<int> bin_start_, bin_cell_;
};

}  // namespace snag
