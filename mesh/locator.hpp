#pragma once
// Which cell holds a point: a grid of bins over the owned cells, exact by the signs at the cell's faces.
//
// Cells of a turning zone are searched where the mesh file has them, with the point turned back; the signs are those of the mesh as it
// stands. So a locator holds at every angle, and gives the same answers whenever it was made.
#include <memory>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

/// Around cells, m; lower is above upper where there is none.
struct CellBox {
  Vec3 lower, upper;
  /// Whether a point lies within `margin` of the box, m. One on a face of the box does, whatever its round-off.
  bool is_near(const Vec3& x, double margin) const {
    const Vec3 size = upper - lower;
    if (size.x < 0) return false;
    const double reach = margin + 1e-9 * (size.x + size.y + size.z);
    for (int i = 0; i < 3; ++i)
      if (x[i] < lower[i] - reach || x[i] > upper[i] + reach) return false;
    return true;
  }
};

class CellLocator {
 public:
  explicit CellLocator(const Mesh& mesh);
  ~CellLocator();
  /// Owned cell that holds the point, or -1. A point on a face belongs to the cell of the lower cell_id. `hint`: cell to try first, with
  /// its neighbours. Both sides of a face compute the same sign, so that no point inside a face falls between two cells or two ranks. On an
  /// edge between ranks, or in a sliver at a sliding interface, more than one rank may answer (take the lowest cell_id), and within
  /// round-off of an edge none may (take `nearest`).
  int find(const Vec3& point, int hint = -1) const;
  /// Owned cells whose centres lie within `radius` of the point, appended to `cells`.
  void within(const Vec3& point, double radius, std::vector<int>& cells) const;
  /// Owned cell whose centre is nearest (of equally near ones the lowest cell_id), or -1 on a rank without cells.
  int nearest(const Vec3& point) const;
  /// Box around the owned cells as the mesh stands; lower > upper on a rank without cells.
  CellBox bounds() const;

 private:
  struct Group;  // cells that move together
  enum class Side { outside, on_face, inside };
  double distance_sign(int face, const Vec3& point) const;
  Side side_of(int cell, const Vec3& point) const;
  /// Around the nodes as the mesh stands, or where the mesh file has them; wider at a sliding interface.
  CellBox box_of(int cell, bool as_in_file) const;
  void find_in(const Group& group, const Vec3& point, int& found, Side& side) const;

  const Mesh& mesh_;
  std::vector<char> at_interface_;    // [n_cells]
  std::vector<int> interface_cells_;  // those
  std::vector<int> nodes_;            // of the owned cells
  std::vector<std::unique_ptr<Group>> groups_;
};

}  // namespace snag
