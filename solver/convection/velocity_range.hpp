#pragma once
// Range of the velocity that a limiter leaves to the faces of a cell, each component by itself:
//
//   [min u, max u]   over the cell and its neighbours; over these, their neighbours and the velocities given at their boundary faces in a
//                    tetrahedron
//
// The four neighbours of a tetrahedron need not lie around the centres of its faces: of a linear velocity a face can have more than all of
// them, and a limiter would cut its slope. A facet counts with its share, so that a sliver that comes or goes changes nothing.
#include <algorithm>
#include <cstdint>
#include <span>

#include "mesh/mesh.hpp"
#include "solver/fields/face.hpp"

namespace snag {

/// x, y, z and a place that is not used: all components of a vector in one instruction.
using FourValues = double __attribute__((vector_size(4 * sizeof(double))));
inline FourValues four(const Vec3& v) { return FourValues{v.x, v.y, v.z, 0}; }
inline FourValues least(const FourValues& a, const FourValues& b) { return b < a ? b : a; }
inline FourValues largest(const FourValues& a, const FourValues& b) { return a < b ? b : a; }

/// Weight of face f in a limiter of cell c: of a facet 1 from a quarter of the cell's face on, 0 when it is a sliver that comes or goes.
inline double weight_in_cell(const Mesh& mesh, int f, int c) {
  return f < mesh.first_facet ? 1 : std::min(1.0, 4 * share_of_face(mesh, f, mesh.owner[f] == c));
}

/// m/s.
struct VelocityRange {
  Vec3 lowest, highest;
};

/// What limiters of components allow in tetrahedra; empty on a mesh without them.
struct TetrahedronRanges {
  std::span<const VelocityRange> near;           // of a cell, its neighbours and its boundary, [n_all_cells], ghosts filled
  std::span<const std::uint8_t> is_tetrahedron;  // [n_cells]
  bool has(int cell) const { return !is_tetrahedron.empty() && is_tetrahedron[static_cast<std::size_t>(cell)] != 0; }
};

/// The same while it is computed with.
struct FourRange {
  FourValues lowest, highest;
};
inline FourRange four(const VelocityRange& range) { return {four(range.lowest), four(range.highest)}; }
inline VelocityRange three(const FourRange& range) {
  return {{range.lowest[0], range.lowest[1], range.lowest[2]}, {range.highest[0], range.highest[1], range.highest[2]}};
}
inline FourRange enclosing(const FourRange& a, const FourRange& b) { return {least(a.lowest, b.lowest), largest(a.highest, b.highest)}; }

/// Range of an owned cell and its neighbours from `of_cell(c)`, that of each.
template <class OfCell>
[[gnu::always_inline]] inline FourRange range_of_neighbours(const Mesh& mesh, int c, const OfCell& of_cell) {
  const FourRange here = of_cell(c);
  FourRange range = here;
  for (int k = mesh.cell_face_start[c]; k < mesh.cell_face_start[c + 1]; ++k) {
    const int f = mesh.cell_face[k];
    if (f >= mesh.n_interior) continue;
    FourRange other = of_cell(mesh.owner[f] + mesh.neighbour[f] - c);
    if (f >= mesh.first_facet) {
      const double weight = weight_in_cell(mesh, f, c);
      other = {here.lowest + weight * (other.lowest - here.lowest), here.highest + weight * (other.highest - here.highest)};
    }
    range = enclosing(range, other);
  }
  return range;
}

/// Over the velocities themselves, u [n_all_cells].
[[gnu::always_inline]] inline FourRange range_of_neighbours(const Mesh& mesh, int c, std::span<const Vec3> u) {
  return range_of_neighbours(mesh, c, [u](int cell) {
    const FourValues here = four(u[static_cast<std::size_t>(cell)]);
    return FourRange{here, here};
  });
}

/// What limiters of components allow in an owned cell.
[[gnu::always_inline]] inline FourRange range_of_cell(const Mesh& mesh, int c, std::span<const Vec3> u, const TetrahedronRanges& wide) {
  if (!wide.has(c)) return range_of_neighbours(mesh, c, u);
  return range_of_neighbours(mesh, c, [&wide](int cell) { return four(wide.near[static_cast<std::size_t>(cell)]); });
}

}  // namespace snag
