#pragma once
// Narrow gaps between walls: where cloth has to be thin to enter.
//
// Samples are four points of every triangle. The gap at a sample is the distance to the nearest triangle or plane that faces it: its normal
// into the fluid makes more than 135 degrees with that of the sample, and the sample lies in the fluid before it. Planes face each other
// where they are parallel. A coarse surface may hide a narrower place between its samples.
#include <vector>

#include "dem/walls/walls.hpp"

namespace snag {

/// The narrowest place between two parts of the walls (or of one part with itself).
struct WallGap {
  int part_1 = 0, part_2 = 0;  // part_1 <= part_2
  double width = 0;            // m
  Vec3 place;                  // a point on one of the walls, m
};

/// Gaps narrower than `widest` (m) with the walls where they are at a time, s; the narrowest first, one for each pair of parts.
std::vector<WallGap> narrow_gaps(const WallSet& walls, double time, double widest);

}  // namespace snag
