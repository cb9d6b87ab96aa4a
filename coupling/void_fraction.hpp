#pragma once
#include <algorithm>

namespace snag {

/// epsilon = 1 - solid fraction, at least 0.1: folds closer than the kernel resolves, whose solid fraction may pass 1, count as 0.9.
inline double void_fraction(double solid_fraction) { return std::max(1 - solid_fraction, 0.1); }

}  // namespace snag
