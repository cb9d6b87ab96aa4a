#pragma once
// A rectangular block as a box of hexahedra (swept from a point, with any distribution along each axis) or of tetrahedra.
#include <array>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "mesh/generate/geometry.hpp"

namespace snag::generate {

/// Positions 0 < ... <= 1 of n cells whose sizes follow a geometric series from both ends (or from the first) with the largest cell
/// `ratio` times the smallest.
std::vector<double> graded(int n, double ratio, bool both_ends);

struct Block {
  Vec3 lower, upper;                                  // m
  std::array<std::vector<double>, 3> positions;       // hexahedra: ends of the cells along each axis, in parts of its length
  std::array<std::array<std::string, 2>, 3> patches;  // names of the faces, [axis][lower, upper]; equal names share one surface
  std::array<bool, 3> periodic{};                     // upper face is a copy of the lower one
};

/// Swept hexahedra; all quality is in `positions`.
Expectation hexahedra(const Block& block);
/// Tetrahedra whose size is a formula in x, y, z (m).
Expectation tetrahedra(const Block& block, const std::string& size);

}  // namespace snag::generate
