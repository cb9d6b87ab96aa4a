#pragma once
// A sector of a round pipe, periodic along it, for developed flow.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/import/parts.hpp"
#include "parallel/sum.hpp"
#include "solver/fields/flow.hpp"

namespace snag::test {

/// Distances of rings from the axis, outwards: of the same width but for those at the wall, the first of which has its centre at y_first.
inline std::vector<double> rings(int n_core, double y_first, double radius) {
  std::vector<double> r{radius};
  for (double width = 2 * y_first; r.back() > width; width = std::min(1.2 * width, radius / n_core)) r.push_back(r.back() - width);
  if (r.back() < 0.5 * radius / n_core) r.pop_back();
  std::reverse(r.begin(), r.end());
  return r;
}

/// A sector of a pipe, 5 degrees wide, of rings at these distances from the axis: a prism at the axis, then hexahedra; two cells along its
/// period.
inline Mesh pipe_sector(const std::vector<double>& ring) {
  const int n_radial = static_cast<int>(ring.size());
  constexpr double half = 2.5 * std::numbers::pi / 180, length = 0.4;
  constexpr int n_long = 2;
  MeshParts parts;
  parts.comm = MPI_COMM_SELF, parts.source = "pipe sector";
  parts.zones = {"fluid"}, parts.patches = {"wall", "low", "high", "begin", "end"};
  parts.periodic = {{"begin", "end", {length, 0, 0}}};
  const int level = 2 * n_radial + 1;
  const auto axis = [&](int i) { return i * level; };
  const auto low = [&](int i, int j) { return i * level + 2 * j - 1; };  // j-th ring, from 1
  const auto high = [&](int i, int j) { return i * level + 2 * j; };
  for (int i = 0; i <= n_long; ++i) {
    const double x = length * i / n_long;
    parts.node.push_back({x, 0, 0});
    for (int j = 1; j <= n_radial; ++j)  // the chord of the wall is one radius from the axis: hydraulic diameter 2 R
      for (const double side : {-1.0, 1.0}) parts.node.push_back({x, ring[j - 1], side * std::tan(half) * ring[j - 1]});
  }
  for (std::size_t i = 0; i < parts.node.size(); ++i) parts.node_id.push_back(static_cast<std::int64_t>(i));
  const auto face = [&](int patch, std::vector<int> nodes) {
    add_boundary_face(parts, patch, nodes.data(), static_cast<int>(nodes.size()));
  };
  for (int i = 0; i < n_long; ++i) {
    const int a = axis(i), b = axis(i + 1);
    const std::vector<int> prism{a, high(i, 1), low(i, 1), b, high(i + 1, 1), low(i + 1, 1)};
    add_cell(parts, CellShape::prism, prism.data(), 6);
    face(1, {a, low(i, 1), low(i + 1, 1), b}), face(2, {a, high(i, 1), high(i + 1, 1), b});
    if (i == 0) face(3, {a, low(i, 1), high(i, 1)});
    if (i + 1 == n_long) face(4, {b, low(i + 1, 1), high(i + 1, 1)});
    for (int j = 1; j < n_radial; ++j) {
      const std::vector<int> here{low(i, j), low(i, j + 1), high(i, j + 1), high(i, j)};
      const std::vector<int> there{low(i + 1, j), low(i + 1, j + 1), high(i + 1, j + 1), high(i + 1, j)};
      std::vector<int> hexahedron = here;
      hexahedron.insert(hexahedron.end(), there.begin(), there.end());
      add_cell(parts, CellShape::hexahedron, hexahedron.data(), 8);
      face(1, {here[0], here[1], there[1], there[0]}), face(2, {here[3], here[2], there[2], there[3]});
      if (j + 1 == n_radial) face(0, {here[1], here[2], there[2], there[1]});
      if (i == 0) face(3, here);
      if (i + 1 == n_long) face(4, there);
    }
  }
  parts.n_owned = static_cast<int>(parts.shape.size());
  for (int c = 0; c < parts.n_owned; ++c) parts.cell_id.push_back(c), parts.zone.push_back(0);
  return build_mesh(std::move(parts));
}

/// Of the volume, along x, m/s.
inline double mean_velocity(const Flow& flow) {
  double through = 0, volume = 0;
  for (int c = 0; c < flow.mesh.n_cells; ++c) through += flow.mesh.cell_volume[c] * flow.velocity[c].x, volume += flow.mesh.cell_volume[c];
  return sum(flow.mesh.comm, through) / sum(flow.mesh.comm, volume);
}

inline const char* const sector_boundary = R"(
[[boundary]]
patch = "wall"
kind = "wall"
[[boundary]]
patches = ["low", "high"]
kind = "symmetry"
)";

}  // namespace snag::test
