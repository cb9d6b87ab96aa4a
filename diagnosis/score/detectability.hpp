#pragma once
// How clearly a signal stands out of noise and uncertain inputs.
#include <string>
#include <vector>

namespace snag {

struct SignalSize {
  double detectability = 0;   // d
  double gap_over_floor = 0;  // rms of signal over floor, sample by sample
};

/// d^2 = S^T C^-1 S - b^T (I + J^T C^-1 J)^-1 b,   b = J^T C^-1 S: the signal S over the noise of variances C, with the directions J of
/// the uncertain inputs (each a column of S's length, one standard uncertainty) projected out by their priors.
/// The floor of a sample: C + sum J^2.
SignalSize signal_size(const std::vector<double>& S, const std::vector<double>& C, const std::vector<std::vector<double>>& J);

}  // namespace snag
