#pragma once
// A cloth as large as it is: its particles are the middles of squares, so that it reaches beyond the triangles between their centres.
#include <array>
#include <span>
#include <vector>

#include "base/vec3.hpp"

namespace snag {

struct ClothToRim {
  std::vector<Vec3> points;                   // those given, then those of the rim, m
  std::vector<std::array<int, 3>> triangles;  // those given, then those of the rim
  std::vector<int> loose;                     // particles without a triangle, whose place a picture shows as a disc
};

/// Continues a cloth beyond its hem along its own plane by the radius of its particles there, m, corners included; where it is folded or
/// seen from its edge, it has no thickness. `triangles`: two a cell of the lattice one after the other, (a, b, d) and (a, d, c), as of
/// dem/rag_measures.hpp; others are taken as they are.
ClothToRim cloth_to_rim(std::span<const Vec3> points, std::span<const double> radius, std::span<const std::array<int, 3>> triangles);

}  // namespace snag
