#pragma once
// Meshes of plane flows: the cells (i, j) of a grid of lines, one cell thick, on one rank.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "mesh/import/parts.hpp"

namespace snag::test {

/// Sides of a cell in its plane.
enum class GridSide { low_i, high_i, low_j, high_j };

struct PlanarGrid {
  int n_i = 1, n_j = 1;
  bool closed = false;                                                   // cell n_i - 1 is followed by cell 0
  double depth = 1;                                                      // along z, m
  std::function<Vec3(int, int)> node{};                                  // of lines i in [0, n_i], j in [0, n_j], at z = 0
  std::function<bool(int, int)> filled = [](int, int) { return true; };  // cells that exist
  std::function<std::string(int, int, GridSide)> patch{};                // of the outer sides of cell (i, j)
  std::vector<std::string> patches{};                                    // all names; "sides", at z = 0 and z = depth, is added
};

inline Mesh plane_mesh(const PlanarGrid& grid) {
  MeshParts parts;
  parts.source = "plane grid", parts.zones = {"fluid"}, parts.patches = grid.patches;
  parts.patches.emplace_back("sides");
  const int n_lines = grid.closed ? grid.n_i : grid.n_i + 1, layer = n_lines * (grid.n_j + 1);
  const auto exists = [&](int i, int j) {
    if (grid.closed) i = (i + grid.n_i) % grid.n_i;
    return i >= 0 && i < grid.n_i && j >= 0 && j < grid.n_j && grid.filled(i, j);
  };
  std::vector<int> local(static_cast<std::size_t>(2 * layer), -1);  // of nodes that are used
  const auto node = [&](int i, int j, int level) {
    int& n = local[static_cast<std::size_t>(i % n_lines + n_lines * j + layer * level)];
    if (n < 0) {
      n = static_cast<int>(parts.node.size());
      parts.node.push_back(grid.node(i % n_lines, j) + Vec3{0, 0, level * grid.depth}), parts.node_id.push_back(n);
    }
    return n;
  };
  for (int j = 0; j < grid.n_j; ++j)
    for (int i = 0; i < grid.n_i; ++i) {
      if (!exists(i, j)) continue;
      const std::vector<int> n{node(i, j, 0), node(i + 1, j, 0), node(i + 1, j + 1, 0), node(i, j + 1, 0),
                               node(i, j, 1), node(i + 1, j, 1), node(i + 1, j + 1, 1), node(i, j + 1, 1)};
      parts.cell_id.push_back(static_cast<std::int64_t>(parts.cell_id.size())), parts.zone.push_back(0);
      add_cell(parts, CellShape::hexahedron, n.data(), 8);
      const auto face = [&](const std::string& name, std::array<int, 4> corner) {
        const std::array<int, 4> nodes{n[corner[0]], n[corner[1]], n[corner[2]], n[corner[3]]};
        const auto place = std::find(parts.patches.begin(), parts.patches.end(), name) - parts.patches.begin();
        add_boundary_face(parts, static_cast<int>(place), nodes.data(), 4);
      };
      if (!exists(i - 1, j)) face(grid.patch(i, j, GridSide::low_i), {0, 3, 7, 4});
      if (!exists(i + 1, j)) face(grid.patch(i, j, GridSide::high_i), {1, 2, 6, 5});
      if (!exists(i, j - 1)) face(grid.patch(i, j, GridSide::low_j), {0, 1, 5, 4});
      if (!exists(i, j + 1)) face(grid.patch(i, j, GridSide::high_j), {3, 2, 6, 7});
      face("sides", {0, 1, 2, 3}), face("sides", {4, 5, 6, 7});
    }
  parts.n_owned = static_cast<int>(parts.shape.size());
  return build_mesh(std::move(parts));
}

/// Places 0 ... 1 of the n + 1 lines of n intervals that grow in geometric progression, the last `ratio` times as wide as the first.
inline std::vector<double> graded(int n, double ratio) {
  const double growth = n > 1 ? std::pow(ratio, 1.0 / (n - 1)) : 1;
  std::vector<double> place{0};
  double width = 1;
  for (int i = 0; i < n; ++i, width *= growth) place.push_back(place.back() + width);
  for (double& x : place) x /= place.back();
  place.back() = 1;
  return place;
}

}  // namespace snag::test
