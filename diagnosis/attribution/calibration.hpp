#pragma once
// How much the evidence of this diagnosis overstates: its logarithms are divided by this temperature before probabilities are printed.

namespace snag {

struct Calibration {
  double temperature = 1;
  const char* source = "";
};

/// The stored calibration.
Calibration calibration();

}  // namespace snag
