#pragma once
// The report of a calibration: what was measured and what the calibrated cloth does, test by test.
#include <optional>
#include <string>
#include <vector>

#include "report/cloth_drawings.hpp"
#include "textile/independence.hpp"

namespace snag {

/// Strips over the edge, the drape from above and the outlines of all its seeds.
std::vector<NamedDrawing> calibration_drawings(const TextileTests& tests, const Calibration& calibration);

/// Independence of numerical parameters, at the particle radius of one calibration.
struct IndependencePart {
  double radius = 0;  // m
  Independence found;
  std::vector<NamedDrawing> drawings;
};

/// One self-contained HTML page; `drawings[i]` belong to calibration i.
std::string calibration_page(const TextileTests& tests, const std::vector<Calibration>& calibrations,
                             const std::vector<std::vector<NamedDrawing>>& drawings, const std::optional<IndependencePart>& independence);

}  // namespace snag
