// A cell is the intersection of the inner sides of its faces. The side of a point p at a face is the sign of
//
//   triangle (a, b, c), a of the lowest node_id:   (b - a) x (c - a) . (p - a)
//   quadrilateral:  S_t.(p - m), where t is the triangle (a, b, m) of the face, m the mean of its nodes, in whose sector
//                   about m along S the point lies:
//                   ((a - m) x (p - m)).S >= 0  and  ((p - m) x (b - m)).S >= 0
//
// This number belongs to the face, not to a cell: what one cell rejects its neighbour accepts, also across ranks. A cell that touches a
// sliding interface ends there at the surface of revolution, which the facets are not asked about.
#include "mesh/locator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/geometry.hpp"
#include "mesh/point_tree.hpp"

namespace snag {
namespace {

constexpr double huge = std::numeric_limits<double>::max();
// A cell at a sliding interface ends at the surface of revolution, which lies outside its nodes by a small share of its size.
constexpr double interface_margin = 0.25;
constexpr double round_off = 1e-9;  // of a box's size, against points on its faces
// Nodes of the interface are where the mesh file has them, to its digits; one more beside it would do no harm.
constexpr double node_tolerance = 1e-5;

CellBox empty_box() { return {{huge, huge, huge}, {-huge, -huge, -huge}}; }

void add(CellBox& box, const Vec3& x) {
  for (int axis = 0; axis < 3; ++axis)
    box.lower[axis] = std::min(box.lower[axis], x[axis]), box.upper[axis] = std::max(box.upper[axis], x[axis]);
}

bool holds(const CellBox& box, const Vec3& x) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(x[axis] >= box.lower[axis] && x[axis] <= box.upper[axis])) return false;
  return true;
}

/// Collects all cells within a radius; `cell`: of each point of the tree.
struct CellsWithin {
  double radius_squared;
  const std::vector<int>& cell;
  std::vector<int>& cells;
  std::size_t size() const { return cells.size(); }
  bool full() const { return true; }
  double worstDist() const { return radius_squared; }
  bool addPoint(double, unsigned place) {
    cells.push_back(cell[place]);
    return true;
  }
};

/// Keeps the nearest cell; of those equally near (to 1e-12, centres being rounded) the one of the lowest cell_id.
struct NearestCell {
  const Mesh& mesh;
  const std::vector<int>* cell_of_place = nullptr;
  int cell = -1;
  double distance_squared = huge / 4;
  static constexpr double slack = 1 + 1e-12;
  std::size_t size() const { return cell >= 0; }
  bool full() const { return cell >= 0; }
  double worstDist() const { return distance_squared * slack; }
  bool addPoint(double candidate_squared, unsigned place) {
    const int other = (*cell_of_place)[place];
    const bool is_tie = candidate_squared <= distance_squared * slack && candidate_squared * slack >= distance_squared;
    if (is_tie ? mesh.cell_id[other] < mesh.cell_id[cell] : candidate_squared < distance_squared)
      cell = other, distance_squared = candidate_squared;
    return true;
  }
};

}  // namespace

/// Cells that stand, or that turn: their centres in a tree and their boxes in bins, where the mesh file has them.
struct CellLocator::Group {
  bool turns = false;
  std::vector<int> cell;
  std::vector<Vec3> centre;  // [cell.size()]
  std::unique_ptr<PointTree> tree;
  CellBox box = empty_box();
  std::array<int, 3> n_bins{};
  Vec3 bin_width;
  std::vector<int> bin_start, bin_cell;  // compressed rows of the cells whose box meets the bin

  Vec3 in_file(const Mesh& mesh, const Vec3& point) const { return turns ? mesh.turning.turned_back(point) : point; }

  int bin_along(int axis, double coordinate) const {
    const int bin = static_cast<int>((coordinate - box.lower[axis]) / bin_width[axis]);
    return std::clamp(bin, 0, n_bins[static_cast<std::size_t>(axis)] - 1);
  }
  int bin_of(const Vec3& x) const { return bin_along(0, x.x) + n_bins[0] * (bin_along(1, x.y) + n_bins[1] * bin_along(2, x.z)); }

  void fill_bins(const std::vector<CellBox>& boxes) {
    for (const CellBox& of_cell : boxes) add(box, of_cell.lower), add(box, of_cell.upper);
    const Vec3 width = box.upper - box.lower;
    const double bin_size = std::cbrt(width.x * width.y * width.z / (2.0 * static_cast<double>(boxes.size())));  // two bins a cell
    for (int axis = 0; axis < 3; ++axis) {
      n_bins[static_cast<std::size_t>(axis)] = std::clamp(static_cast<int>(width[axis] / bin_size), 1, 2048);
      bin_width[axis] = width[axis] / n_bins[static_cast<std::size_t>(axis)];
    }
    const auto for_each_bin = [&](const auto& act) {
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        const auto& [low, high] = boxes[i];
        for (int k = bin_along(2, low.z); k <= bin_along(2, high.z); ++k)
          for (int j = bin_along(1, low.y); j <= bin_along(1, high.y); ++j)
            for (int l = bin_along(0, low.x); l <= bin_along(0, high.x); ++l) act(cell[i], l + n_bins[0] * (j + n_bins[1] * k));
      }
    };
    bin_start.assign(static_cast<std::size_t>(n_bins[0]) * n_bins[1] * n_bins[2] + 1, 0);
    for_each_bin([&](int, int bin) { ++bin_start[bin + 1]; });
    for (std::size_t b = 1; b < bin_start.size(); ++b) bin_start[b] += bin_start[b - 1];
    bin_cell.resize(static_cast<std::size_t>(bin_start.back()));
    std::vector<int> next(bin_start.begin(), bin_start.end() - 1);
    for_each_bin([&](int c, int bin) { bin_cell[next[bin]++] = c; });
  }
};

CellLocator::CellLocator(const Mesh& mesh) : mesh_(mesh), at_interface_(static_cast<std::size_t>(mesh.n_cells), 0) {
  if (mesh.turning.zone >= 0) {
    std::vector<char> on_interface;
    for (const Vec3& node : mesh.node)
      on_interface.push_back(std::abs(mesh.turning.distance(node)) < node_tolerance * norm(node - mesh.turning.origin));
    for (int c = 0; c < mesh.n_cells; ++c)
      for (const int node : row(mesh.cell_node_start, mesh.cell_node, c)) at_interface_[c] |= on_interface[node];
  }
  std::vector<char> is_corner(mesh.node.size(), 0);
  for (int c = 0; c < mesh.n_cells; ++c) {
    if (at_interface_[c]) interface_cells_.push_back(c);
    for (const int node : row(mesh.cell_node_start, mesh.cell_node, c)) is_corner[node] = 1;
  }
  for (std::size_t node = 0; node < is_corner.size(); ++node)
    if (is_corner[node]) nodes_.push_back(static_cast<int>(node));
  for (const bool turns : {false, true}) {
    auto group = std::make_unique<Group>();
    group->turns = turns;
    std::vector<int> cells;
    std::vector<Vec3> centres;
    for (int c = 0; c < mesh.n_cells; ++c) {
      const bool cell_turns = mesh.turning.zone >= 0 && mesh.cell_zone[c] == mesh.turning.zone;
      if (cell_turns != turns) continue;
      cells.push_back(c);
      centres.push_back(group->in_file(mesh, mesh.cell_centre[c]));
    }
    if (cells.empty()) continue;
    const PointTree unsorted(centres);
    std::vector<CellBox> boxes;
    for (const unsigned i : unsorted.order_of_leaves()) {  // so that a search reads cells one after another
      group->cell.push_back(cells[i]), group->centre.push_back(centres[i]);
      boxes.push_back(box_of(cells[i], turns));
    }
    group->tree = std::make_unique<PointTree>(group->centre);
    group->fill_bins(boxes);
    groups_.push_back(std::move(group));
  }
}

CellLocator::~CellLocator() = default;

CellBox CellLocator::box_of(int cell, bool as_in_file) const {
  CellBox box = empty_box();
  for (const int node : row(mesh_.cell_node_start, mesh_.cell_node, cell))
    add(box, as_in_file ? mesh_.turning.turned_back(mesh_.node[node]) : mesh_.node[node]);
  const Vec3 size = box.upper - box.lower;
  const double margin = at_interface_[cell] ? interface_margin : as_in_file ? round_off : 0;
  const double wider = margin * std::max({size.x, size.y, size.z});
  const Vec3 by{wider, wider, wider};
  return {box.lower - by, box.upper + by};
}

CellBox CellLocator::bounds() const {
  CellBox bounds = empty_box();
  for (const int node : nodes_) add(bounds, mesh_.node[node]);
  for (const int cell : interface_cells_) {
    const CellBox box = box_of(cell, false);
    add(bounds, box.lower), add(bounds, box.upper);
  }
  return bounds;
}

double CellLocator::distance_sign(int face, const Vec3& point) const {
  const Vec3& S = mesh_.face_vector[face];
  const auto nodes = row(mesh_.face_node_start, mesh_.face_node, face);
  if (nodes.size() == 3) {
    // Not by S: that of a face with an edge on a surface of revolution is not the normal of its nodes.
    std::size_t first = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (mesh_.node_id[nodes[i]] < mesh_.node_id[nodes[first]]) first = i;
    const Vec3 &a = mesh_.node[nodes[first]], &b = mesh_.node[nodes[(first + 1) % 3]], &c = mesh_.node[nodes[(first + 2) % 3]];
    return dot(cross(b - a, c - a), point - a);
  }
  const auto corner = [&](std::size_t i) -> const Vec3& { return mesh_.node[nodes[i % 4]]; };
  const Vec3 m = 0.25 * (corner(0) + corner(1) + corner(2) + corner(3)), p = point - m;
  std::size_t sector = 0;
  for (std::size_t i = 0; i < 4; ++i)
    if (dot(cross(corner(i) - m, p), S) >= 0 && dot(cross(p, corner(i + 1) - m), S) >= 0) {
      sector = i;
      break;
    }
  return dot(cross(corner(sector) - m, corner(sector + 1) - m), p);
}

CellLocator::Side CellLocator::side_of(int cell, const Vec3& point) const {
  const bool at_interface = at_interface_[cell] != 0;
  if (at_interface) {
    const bool turns = mesh_.cell_zone[cell] == mesh_.turning.zone;
    if (!holds(box_of(cell, false), point) || (mesh_.turning.distance(point) < 0) != turns) return Side::outside;
  }
  // Beyond the flat faces of such cells, in the sliver to the surface of revolution, two of them may meet in a wedge: of equal rank there.
  Side side = at_interface ? Side::on_face : Side::inside;
  int previous = -1;
  for (const int face : row(mesh_.cell_face_start, mesh_.cell_face, cell)) {
    if (at_interface && face >= mesh_.first_facet && face < mesh_.n_interior) continue;
    const bool is_owner =
        mesh_.owner[face] == cell && face != previous;  // a cell that is its own neighbour lists the face twice: as owner first
    previous = face;
    if (is_owner) {
      const double sign = distance_sign(face, point);
      if (sign > 0) return Side::outside;
      if (sign == 0) side = Side::on_face;
      continue;
    }
    // The face lies at the owner's end of a period; both ends include their face, for the point is only at one of them.
    const Vec3 shift = mesh_.cell_centre[mesh_.owner[face]] + mesh_.delta[face] - mesh_.cell_centre[cell];
    const bool is_periodic = norm_squared(shift) > 1e-12 * norm_squared(mesh_.delta[face]);
    const double sign = distance_sign(face, is_periodic ? point + shift : point);
    if (is_periodic ? sign < 0 : sign <= 0) return Side::outside;
  }
  return side;
}

/// The cell of one group that holds the point, unless `found` holds it already.
void CellLocator::find_in(const Group& group, const Vec3& point, int& found, Side& side) const {
  const Vec3 x = group.in_file(mesh_, point);
  if (side == Side::inside || !holds(group.box, x)) return;
  const int bin = group.bin_of(x);
  for (int i = group.bin_start[bin]; i < group.bin_start[bin + 1]; ++i) {
    const int cell = group.bin_cell[i];
    const Side here = side_of(cell, point);
    if (here == Side::outside) continue;
    if (here == Side::inside || found < 0 || mesh_.cell_id[cell] < mesh_.cell_id[found]) found = cell, side = here;
    if (here == Side::inside) return;
  }
}

int CellLocator::find(const Vec3& point, int hint) const {
  if (!std::isfinite(point.x + point.y + point.z)) return -1;
  if (hint >= 0 && hint < mesh_.n_cells) {
    if (side_of(hint, point) == Side::inside) return hint;
    for (const int face : row(mesh_.cell_face_start, mesh_.cell_face, hint)) {
      const int other = mesh_.owner[face] == hint ? mesh_.neighbour[face] : mesh_.owner[face];
      if (other >= 0 && other < mesh_.n_cells && side_of(other, point) == Side::inside) return other;
    }
  }
  int found = -1;
  Side side = Side::outside;
  for (const auto& group : groups_) find_in(*group, point, found, side);
  return found;
}

void CellLocator::within(const Vec3& point, double radius, std::vector<int>& cells) const {
  for (const auto& group : groups_) {
    const Vec3 x = group->in_file(mesh_, point);
    CellsWithin result{radius * radius * (1 + 1e-14), group->cell, cells};
    (*group->tree)->findNeighbors(result, &x.x, nanoflann::SearchParams());
  }
}

int CellLocator::nearest(const Vec3& point) const {
  NearestCell result{mesh_};
  for (const auto& group : groups_) {
    const Vec3 x = group->in_file(mesh_, point);
    result.cell_of_place = &group->cell;
    (*group->tree)->findNeighbors(result, &x.x, nanoflann::SearchParams());
  }
  return result.cell;
}

}  // namespace snag
