#pragma once
// Triangulated walls for tests.
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/wall_surface.hpp"

namespace snag::test {

/// Adds a triangle by node numbers; it turns right-handed about its normal OUT of the fluid.
inline void add_triangle(WallSurface& surface, const std::vector<Vec3>& node, int a, int b, int c) {
  WallTriangle t;
  t.node = {node[a], node[b], node[c]};
  t.normal = unit(cross(node[b] - node[a], node[c] - node[a]));
  t.node_index = {a, b, c};
  surface.triangles.push_back(t);
}

/// Quadrilateral sheet of n x m cells, x(u, v) for u, v in 0 .. 1; each cell cut along one diagonal or the other. The normal out of the
/// fluid is dx/dv x dx/du.
template <class Position>
WallSurface sheet(int n, int m, const Position& position, bool periodic_u = false) {
  WallSurface surface;
  surface.parts = {"sheet"};
  std::vector<Vec3> node;
  const int columns = periodic_u ? n : n + 1;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < columns; ++i) node.push_back(position(double(i) / n, double(j) / m));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * columns + i, b = j * columns + (i + 1) % columns, c = b + columns, d = a + columns;
      if ((i + j) % 2 == 0) {
        add_triangle(surface, node, a, c, b), add_triangle(surface, node, a, d, c);
      } else {
        add_triangle(surface, node, a, d, b), add_triangle(surface, node, b, d, c);
      }
    }
  return surface;
}

/// A closed box of solid around which the fluid is.
inline WallSurface solid_box(const Vec3& lower, const Vec3& upper) {
  WallSurface surface;
  surface.parts = {"solid"};
  std::vector<Vec3> node;
  for (int k = 0; k < 8; ++k) node.push_back({k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z});
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};  // seen from outside, left-handed turn below
  for (const auto& f : faces) {
    add_triangle(surface, node, f[0], f[2], f[1]);
    add_triangle(surface, node, f[0], f[3], f[2]);
  }
  return surface;
}

}  // namespace snag::test
