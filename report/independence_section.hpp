#pragma once
// The part of a calibration's report on particle radius, time step, dashpots and friction (Jensen 2018, Appendix 1).
#include "report/calibration_page.hpp"

namespace snag {

/// Strips of all radii, outlines of the drape with other dashpots and other rotation friction.
std::vector<NamedDrawing> independence_drawings(const TextileTests& tests, const Independence& found);

std::string independence_section(const TextileTests& tests, const IndependencePart& part);

}  // namespace snag
