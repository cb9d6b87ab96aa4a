#pragma once
// The report of a calibration: what was measured and what the calibrated cloth does, test by test.
#include <string>
#include <vector>

#include "dem/calibration/calibration.hpp"

namespace snag {

/// A picture as SVG and the name of its file.
struct NamedDrawing {
  std::string file, caption, svg;
};

/// Strips over the edge, the drape from above and the outlines of all its seeds.
std::vector<NamedDrawing> calibration_drawings(const TextileTests& tests, const Calibration& calibration);

/// One self-contained HTML page; `drawings[i]` belong to calibration i.
std::string calibration_page(const TextileTests& tests, const std::vector<Calibration>& calibrations,
                             const std::vector<std::vector<NamedDrawing>>& drawings);

}  // namespace snag
