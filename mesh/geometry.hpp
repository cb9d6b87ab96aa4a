#pragma once
// Geometry of faces and cells with straight edges; a quadrilateral is the four triangles between its edges and the mean of its nodes.
//
//   triangle t of a face, corners a, b and m (mean of the face's nodes):   S_t = 1/2 (a - m) x (b - m),   x_t = (a + b + m)/3
//   face:   S = sum_t S_t,   x_f = sum_t x_t (S_t.S) / (S.S)        so that S.x_f.S/|S|^2 is the flux of x through the warped face along S
//   cell, tetrahedra from o (mean of the cell's nodes) to every triangle, S_t out of the cell:
//           V = sum_t V_t,   V_t = (x_t - o).S_t / 3,   x_P = o + 3/4 sum_t V_t (x_t - o) / V
//
// Both cells of a face see the same triangles: volumes tile the domain and sum_f S = 0 for every cell, to round-off. V and x_P are exact
// for this polyhedron.
#include <span>

#include "mesh/mesh.hpp"

namespace snag {

struct FaceGeometry {
  Vec3 vector, centre;  // S, m2; x_f, m
};

/// `nodes`: 3 or 4 points in a cycle that is right-handed about S.
FaceGeometry face_geometry(std::span<const Vec3> nodes);

struct CellGeometry {
  double volume = 0;  // V, m3: negative for an inverted cell
  Vec3 centre;        // x_P, m
};

/// `nodes` in VTK order.
CellGeometry cell_geometry(CellShape shape, std::span<const Vec3> nodes);

/// What the centres of the cells of an interior face lack of `delta`: its way across a period, m; zero elsewhere.
inline Vec3 period(const Mesh& mesh, int f) {
  constexpr double round_off = 1e-12;  // of the square of the way between the centres
  const Vec3& d = mesh.delta[f];
  const Vec3 lack = d - (mesh.cell_centre[mesh.neighbour[f]] - mesh.cell_centre[mesh.owner[f]]);
  return norm_squared(lack) > round_off * norm_squared(d) ? lack : Vec3{};
}

/// Positions of a row of node numbers, at most 8, in `points`.
inline std::span<const Vec3> positions(const std::vector<Vec3>& node, std::span<const int> row, std::array<Vec3, 8>& points) {
  for (std::size_t i = 0; i < row.size(); ++i) points[i] = node[static_cast<std::size_t>(row[i])];
  return {points.data(), row.size()};
}

inline Vec3 mean(std::span<const Vec3> points) {
  Vec3 total;
  for (const Vec3& point : points) total += point;
  return total / static_cast<double>(points.size());
}

/// act(a, b, m) for the triangles of a face between its edges, a to b, and the mean m of its nodes.
template <class Act>
void for_each_triangle(std::span<const Vec3> nodes, const Act& act) {
  const Vec3 m = mean(nodes);
  for (std::size_t i = 0; i < nodes.size(); ++i) act(nodes[i], nodes[(i + 1) % nodes.size()], m);
}

/// Row `i` of compressed rows.
inline std::span<const int> row(const std::vector<int>& start, const std::vector<int>& entries, int i) {
  return {entries.data() + start[i], static_cast<std::size_t>(start[i + 1] - start[i])};
}

/// Fills volumes and centres of cells (owned, then ghosts by halo) and vector, centre, delta, weight, skew_share of faces from nodes and
/// connectivity. `shift[f]`: what to add to the neighbour's centre across a period (only where present). Collective.
void fill_geometry(Mesh& mesh, const std::vector<Vec3>& shift);

}  // namespace snag
