// A cell is the intersection of the inner sides of its faces. The side of a point p at a face with vector S and centre x_f is the sign of
//
//   triangle:       S.(p - x_f)
//   quadrilateral:  S_t.(p - m), where t is the triangle (a, b, m) of the face, m the mean of its nodes, in whose sector
//                   about m along S the point lies:
//                   ((a - m) x (p - m)).S >= 0  and  ((p - m) x (b - m)).S >= 0
//
// This number belongs to the face, not to a cell: what one cell rejects its neighbour accepts, also across ranks.
#include "mesh/locator.hpp"

#include <algorithm>
#include <limits>

#include "mesh/geometry.hpp"
#include "mesh/point_tree.hpp"

namespace snag {
namespace {

/// Collects all cells within a radius.
struct CellsWithin {
  double radius_squared;
  std::vector<int>& cells;
  std::size_t size() const { return cells.size(); }
  bool full() const { return true; }
  double worstDist() const { return radius_squared; }
  bool addPoint(double, unsigned cell) {
    cells.push_back(static_cast<int>(cell));
    return true;
  }
};

/// Keeps the nearest cell; of those equally near (to 1e-12, centres being rounded) the one of the lowest cell_id.
struct NearestCell {
  const Mesh& mesh;
  int cell = -1;
  double distance_squared = std::numeric_limits<double>::max() / 4;
  static constexpr double slack = 1 + 1e-12;
  std::size_t size() const { return cell >= 0; }
  bool full() const { return cell >= 0; }
  double worstDist() const { return distance_squared * slack; }
  bool addPoint(double candidate_squared, unsigned candidate) {
    const int other = static_cast<int>(candidate);
    const bool is_tie = candidate_squared <= distance_squared * slack && candidate_squared * slack >= distance_squared;
    if (is_tie ? mesh.cell_id[other] < mesh.cell_id[cell] : candidate_squared < distance_squared)
      cell = other, distance_squared = candidate_squared;
    return true;
  }
};

}  // namespace

struct CellLocator::CentreTree : PointTree {
  using PointTree::PointTree;
};

CellLocator::CellLocator(const Mesh& mesh) : mesh_(mesh) {
  constexpr double huge = std::numeric_limits<double>::max();
  lower_ = {huge, huge, huge}, upper_ = {-huge, -huge, -huge};
  for (const int node : mesh.cell_node)
    for (int axis = 0; axis < 3; ++axis) {
      lower_[axis] = std::min(lower_[axis], mesh.node[node][axis]);
      upper_[axis] = std::max(upper_[axis], mesh.node[node][axis]);
    }
  if (mesh.n_cells == 0) return;
  centres_ = std::make_unique<CentreTree>(mesh.cell_centre, static_cast<std::size_t>(mesh.n_cells));
  fill_bins();
}

CellLocator::~CellLocator() = default;

int CellLocator::bin_along(int axis, double coordinate) const {
  const int bin = static_cast<int>((coordinate - lower_[axis]) / bin_width_[axis]);
  return std::clamp(bin, 0, n_bins_[static_cast<std::size_t>(axis)] - 1);
}

void CellLocator::fill_bins() {
  const Vec3 width = upper_ - lower_;
  const double bin_size = std::cbrt(width.x * width.y * width.z / (2.0 * mesh_.n_cells));  // two bins a cell on average
  for (int axis = 0; axis < 3; ++axis) {
    n_bins_[static_cast<std::size_t>(axis)] = std::clamp(static_cast<int>(width[axis] / bin_size), 1, 2048);
    bin_width_[axis] = width[axis] / n_bins_[static_cast<std::size_t>(axis)];
  }
  const auto for_each_bin = [&](const auto& act) {
    for (int c = 0; c < mesh_.n_cells; ++c) {
      Vec3 low = mesh_.node[mesh_.cell_node[mesh_.cell_node_start[c]]], high = low;
      for (const int node : row(mesh_.cell_node_start, mesh_.cell_node, c))
        for (int axis = 0; axis < 3; ++axis) {
          low[axis] = std::min(low[axis], mesh_.node[node][axis]);
          high[axis] = std::max(high[axis], mesh_.node[node][axis]);
        }
      for (int k = bin_along(2, low.z); k <= bin_along(2, high.z); ++k)
        for (int j = bin_along(1, low.y); j <= bin_along(1, high.y); ++j)
          for (int i = bin_along(0, low.x); i <= bin_along(0, high.x); ++i) act(c, i + n_bins_[0] * (j + n_bins_[1] * k));
    }
  };
  bin_start_.assign(static_cast<std::size_t>(n_bins_[0]) * n_bins_[1] * n_bins_[2] + 1, 0);
  for_each_bin([&](int, int bin) { ++bin_start_[bin + 1]; });
  for (std::size_t b = 1; b < bin_start_.size(); ++b) bin_start_[b] += bin_start_[b - 1];
  bin_cell_.resize(static_cast<std::size_t>(bin_start_.back()));
  std::vector<int> next(bin_start_.begin(), bin_start_.end() - 1);
  for_each_bin([&](int cell, int bin) { bin_cell_[next[bin]++] = cell; });
}

double CellLocator::distance_sign(int face, const Vec3& point) const {
  const Vec3& S = mesh_.face_vector[face];
  const auto nodes = row(mesh_.face_node_start, mesh_.face_node, face);
  if (nodes.size() == 3) return dot(S, point - mesh_.face_centre[face]);
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
  Side side = Side::inside;
  int previous = -1;
  for (const int face : row(mesh_.cell_face_start, mesh_.cell_face, cell)) {
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

int CellLocator::find(const Vec3& point, int hint) const {
  for (int axis = 0; axis < 3; ++axis)
    if (!(point[axis] >= lower_[axis] && point[axis] <= upper_[axis])) return -1;
  if (hint >= 0 && hint < mesh_.n_cells) {
    if (side_of(hint, point) == Side::inside) return hint;
    for (const int face : row(mesh_.cell_face_start, mesh_.cell_face, hint)) {
      const int other = mesh_.owner[face] == hint ? mesh_.neighbour[face] : mesh_.owner[face];
      if (other >= 0 && other < mesh_.n_cells && side_of(other, point) == Side::inside) return other;
    }
  }
  const int bin = bin_along(0, point.x) + n_bins_[0] * (bin_along(1, point.y) + n_bins_[1] * bin_along(2, point.z));
  int found = -1;
  for (int i = bin_start_[bin]; i < bin_start_[bin + 1]; ++i) {
    const int cell = bin_cell_[i];
    const Side side = side_of(cell, point);
    if (side == Side::inside) return cell;
    if (side == Side::on_face && (found < 0 || mesh_.cell_id[cell] < mesh_.cell_id[found])) found = cell;
  }
  return found;
}

void CellLocator::within(const Vec3& point, double radius, std::vector<int>& cells) const {
  if (!centres_) return;
  CellsWithin result{radius * radius * (1 + 1e-14), cells};
  (*centres_)->findNeighbors(result, &point.x, nanoflann::SearchParams());
}

int CellLocator::nearest(const Vec3& point) const {
  if (!centres_) return -1;
  NearestCell result{mesh_};
  (*centres_)->findNeighbors(result, &point.x, nanoflann::SearchParams());
  return result.cell;
}

}  // namespace snag
