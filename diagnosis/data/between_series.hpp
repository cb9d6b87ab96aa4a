#pragma once
// What differs between series of one condition: points of different groups (OperatingPoint::group: one day, one set-up, one speed of what
// should not matter) that have the same case should have the same means. Where they differ by more than repeats scatter, each group has a
// deviation of its own, common to its points, with the variance of DerSimonian and Laird: over sets of k such points, with w = 1/u^2,
//
//   tau^2 = max(0, sum (Q - (k - 1)) / sum (W - sum w^2 / W)),   Q = sum w (y - y_mean)^2,   W = sum w
//
// Only points of training are asked. Source: DerSimonian and Laird (1986), Control. Clin. Trials 7, 177-188.
#include <string>
#include <vector>

#include "diagnosis/data/summary.hpp"

namespace snag {

struct BetweenSeries {
  std::string name;  // "series:y@GROUP"
  int observable = 0;
  std::vector<int> points;  // of the group
  double u = 0;             // tau, SI
};

/// One for each group and each Gaussian observable that differs; none where no points of different groups have the same case.
std::vector<BetweenSeries> between_series(const Experiment& experiment, const std::vector<PointSummary>& summaries);

}  // namespace snag
