#pragma once
// Shapes in time of what no effect describes, a Gaussian process: g(t) g(t') exp(-(t - t')^2 / 2 l^2), g = 1 or t/T.
#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/data/summary.hpp"

namespace snag {

/// Lengths l over the duration T.
inline constexpr std::array discrepancy_lengths{0.1, 0.3, 1.0};

struct DiscrepancyShape {
  double length = 0;     // over the duration
  bool growing = false;  // g = t/T
};

/// Between two Gaussian rows of a point; 0 between observables.
inline double discrepancy_correlation(const PointSummary& point, int i, int j, const DiscrepancyShape& shape) {
  if (point.rows[i].observable != point.rows[j].observable) return 0;
  const double duration = std::max(point.duration, 1e-300);
  const auto time = [&](const Row& row) { return row.kind == Row::Kind::path ? 0.5 * (row.begin + row.end) / duration : 1; };
  const double a = time(point.rows[i]), b = time(point.rows[j]), apart = (a - b) / shape.length;
  return (shape.growing ? a * b : 1) * std::exp(-0.5 * apart * apart);
}

}  // namespace snag
