#pragma once
// How much the evidence of this diagnosis overstates: log-posteriors are divided by this temperature before they are printed.

namespace snag {

struct Calibration {
  double temperature = 1;
  const char* source = "";
};

/// The stored calibration.
Calibration calibration();

}  // namespace snag
