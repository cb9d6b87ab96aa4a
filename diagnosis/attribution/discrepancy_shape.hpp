#pragma once
// Shapes in time of what no effect describes, a Gaussian process: g(t) g(t') exp(-(t - t')^2 / 2 l^2), g = 1 or t/T.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/data/summary.hpp"

namespace snag {

struct DiscrepancyShape {
  double length;  // over the duration
  bool growing;   // g = t/T
};
inline constexpr std::array<DiscrepancyShape, 6> discrepancy_shapes{
    {{0.1, false}, {0.1, true}, {0.3, false}, {0.3, true}, {1.0, false}, {1.0, true}}};

/// Between the Gaussian rows of a point; 0 between observables.
inline Eigen::MatrixXd discrepancy_correlation(const PointSummary& point, const DiscrepancyShape& shape) {
  const double duration = std::max(point.duration, 1e-300);
  const auto time = [&](const Row& row) { return row.kind == Row::Kind::path ? 0.5 * (row.begin + row.end) / duration : 1; };
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(point.n_gaussian, point.n_gaussian);
  for (int i = 0; i < point.n_gaussian; ++i) {
    for (int j = 0; j <= i; ++j) {
      if (point.rows[i].observable != point.rows[j].observable) continue;
      const double a = time(point.rows[i]), b = time(point.rows[j]), apart = (a - b) / shape.length;
      R(i, j) = R(j, i) = (shape.growing ? a * b : 1) * std::exp(-0.5 * apart * apart);
    }
  }
  return R;
}

}  // namespace snag
