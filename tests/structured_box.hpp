#pragma once
// Boxes of hexahedra or tetrahedra without a file, for tests.
//
// Cell (i, j, k) has the number i + n_x (j + n_y k); node (i, j, k) likewise with n + 1 nodes along each axis. Rank r owns the slabs k of
// an equal share.
// Tetrahedra: the six paths of Kuhn from corner 0 to corner 6 of each hexahedron; diagonals of opposite faces are parallel, so that all
// faces match, across periods too.
#include <array>
#include <cstdint>

#include "base/error.hpp"
#include "base/random_numbers.hpp"
#include "base/words.hpp"
#include "mesh/import/parts.hpp"
#include "mesh/mesh.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace structured {

struct Box {
  Vec3 lower, upper;
  std::array<int, 3> n;
  int first = 0, last = 0;  // slabs [first, last) of this rank
  bool tetrahedra = false;
  double distortion = 0;  // largest displacement of an inner node along each axis, in spacings

  int n_nodes(int axis) const { return n[static_cast<std::size_t>(axis)] + 1; }
  std::int64_t node_id(int i, int j, int k) const { return i + std::int64_t{n_nodes(0)} * (j + std::int64_t{n_nodes(1)} * k); }
  Vec3 position(int i, int j, int k) const {
    const auto along = [this](int axis, int index) {
      const double fraction = static_cast<double>(index) / n[static_cast<std::size_t>(axis)];
      return (1 - fraction) * lower[axis] + fraction * upper[axis];
    };
    return {along(0, i), along(1, j), along(2, k)};
  }
  Vec3 node_position(int i, int j, int k) const {
    Vec3 x = position(i, j, k);
    if (i == 0 || i == n[0] || j == 0 || j == n[1] || k == 0 || k == n[2]) return x;
    for (int axis = 0; axis < 3; ++axis)
      x[axis] += distortion * scatter(3 * node_id(i, j, k) + axis) * (upper[axis] - lower[axis]) / n[static_cast<std::size_t>(axis)];
    return x;
  }
  /// A number in [-1, 1] that depends on the node only.
  static double scatter(std::int64_t key) { return 2 * static_cast<double>(mixed(static_cast<std::uint64_t>(key)) >> 11) * 0x1p-53 - 1; }
};

inline constexpr std::array<std::array<int, 4>, 6> kuhn{
    {{0, 1, 2, 6}, {0, 3, 7, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}, {0, 7, 4, 6}, {0, 2, 3, 6}}};

inline int first_slab(int n_slabs, int rank, int size) { return static_cast<int>(std::int64_t{n_slabs} * rank / size); }

inline int rank_of_slab(int slab, int n_slabs, int size) {
  int rank = 0;
  while (first_slab(n_slabs, rank + 1, size) <= slab) ++rank;
  return rank;
}

/// The cells of one hexahedron, whose number it is.
inline void add_cells(const Box& box, const std::array<int, 8>& nodes, std::int64_t number, MeshParts& parts) {
  if (!box.tetrahedra) {
    add_cell(parts, CellShape::hexahedron, nodes.data(), 8);
    parts.cell_id.push_back(number), parts.zone.push_back(0);
    return;
  }
  for (int t = 0; t < 6; ++t) {
    std::array<int, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) corners[i] = nodes[static_cast<std::size_t>(kuhn[static_cast<std::size_t>(t)][i])];
    add_cell(parts, CellShape::tetrahedron, corners.data(), 4);
    parts.cell_id.push_back(6 * number + t), parts.zone.push_back(0);
  }
}

/// Slab k: owned, or a ghost slab of another rank. Nodes of the slabs [bottom, ...) lie in parts in the order of their numbers.
inline void add_slab(const Box& box, int k, int bottom, MeshParts& parts) {
  const auto local = [&](int i, int j, int level) { return static_cast<int>(box.node_id(i, j, level) - box.node_id(0, 0, bottom)); };
  const int size = size_of(parts.comm), owner = rank_of_slab(k, box.n[2], size);
  const bool is_ghost = k < box.first || k >= box.last;
  int index = (k - first_slab(box.n[2], owner, size)) * box.n[0] * box.n[1];
  for (int j = 0; j < box.n[1]; ++j)
    for (int i = 0; i < box.n[0]; ++i) {
      const std::array<int, 8> nodes{local(i, j, k),     local(i + 1, j, k),     local(i + 1, j + 1, k),     local(i, j + 1, k),
                                     local(i, j, k + 1), local(i + 1, j, k + 1), local(i + 1, j + 1, k + 1), local(i, j + 1, k + 1)};
      add_cells(box, nodes, i + std::int64_t{box.n[0]} * (j + std::int64_t{box.n[1]} * k), parts);
      const int n_pieces = box.tetrahedra ? 6 : 1;
      for (int piece = 0; piece < n_pieces && is_ghost; ++piece)
        parts.ghost_rank.push_back(owner), parts.ghost_index.push_back(n_pieces * index + piece);
      ++index;
      const auto name = [&](int patch, std::array<int, 4> corner) {
        const std::array<int, 4> face{nodes[corner[0]], nodes[corner[1]], nodes[corner[2]], nodes[corner[3]]};
        if (!box.tetrahedra) return add_boundary_face(parts, patch, face.data(), 4);
        const std::array<int, 3> half{face[0], face[2], face[3]};  // the diagonal leads from the first corner to the third
        add_boundary_face(parts, patch, face.data(), 3);
        add_boundary_face(parts, patch, half.data(), 3);
      };
      if (i == 0) name(0, {0, 3, 7, 4});
      if (i == box.n[0] - 1) name(1, {1, 2, 6, 5});
      if (j == 0) name(2, {0, 1, 5, 4});
      if (j == box.n[1] - 1) name(3, {3, 2, 6, 7});
      if (k == 0) name(4, {0, 1, 2, 3});
      if (k == box.n[2] - 1) name(5, {4, 5, 6, 7});
    }
}

inline Mesh meshed(MPI_Comm comm, Box box, std::array<bool, 3> periodic) {
  const auto& n = box.n;
  const Vec3 width = box.upper - box.lower;
  for (int axis = 0; axis < 3; ++axis)
    if (n[static_cast<std::size_t>(axis)] < 1 || !(width[axis] > 0))
      throw Error(ExitCode::mesh, "structured box: axis " + std::to_string(axis) + " has " +
                                      std::to_string(n[static_cast<std::size_t>(axis)]) + " cells over " + number_text(width[axis]) +
                                      " m, at least one cell and a positive width are needed; correct the box");
  MeshParts parts;
  parts.comm = comm;
  parts.source = "structured box";
  parts.zones = {"fluid"};
  parts.patches = {"x0", "x1", "y0", "y1", "z0", "z1"};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    if (!periodic[i]) continue;
    Vec3 translation;
    translation[axis] = width[axis];
    parts.periodic.push_back({parts.patches[2 * i], parts.patches[2 * i + 1], translation});
  }

  const int rank = rank_of(comm), size = size_of(comm);
  box.first = first_slab(n[2], rank, size), box.last = first_slab(n[2], rank + 1, size);
  if (box.first == box.last) return build_mesh(std::move(parts));
  const int bottom = std::max(box.first - 1, 0), top = std::min(box.last + 1, n[2]);
  for (int k = bottom; k <= top; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i) parts.node.push_back(box.node_position(i, j, k)), parts.node_id.push_back(box.node_id(i, j, k));
  for (int k = box.first; k < box.last; ++k) add_slab(box, k, bottom, parts);
  parts.n_owned = static_cast<int>(parts.cell_id.size());
  if (bottom < box.first) add_slab(box, bottom, bottom, parts);
  if (top > box.last) add_slab(box, top - 1, bottom, parts);
  return build_mesh(std::move(parts));
}

}  // namespace structured

/// A box of n[0] x n[1] x n[2] hexahedra; patches x0, x1, y0, y1, z0, z1 (joined to periodic where periodic[axis]); blocks of slabs along z
/// per rank.
inline Mesh structured_box(MPI_Comm comm, Vec3 lower, Vec3 upper, std::array<int, 3> n, std::array<bool, 3> periodic = {}) {
  return structured::meshed(comm, {.lower = lower, .upper = upper, .n = n}, periodic);
}

struct BoxShape {
  Vec3 lower{}, upper{1, 1, 1};  // m
  double distortion = 0;  // inner nodes are displaced by up to this share of the spacing along each axis; below 0.2 no cell turns over
};

/// The same box with each hexahedron cut into six tetrahedra, and its inner nodes displaced at random (the same on any number of ranks).
inline Mesh tetrahedral_box(MPI_Comm comm, const BoxShape& shape, std::array<int, 3> n, std::array<bool, 3> periodic = {}) {
  return structured::meshed(comm, {.lower = shape.lower, .upper = shape.upper, .n = n, .tetrahedra = true, .distortion = shape.distortion},
                            periodic);
}

}  // namespace snag
