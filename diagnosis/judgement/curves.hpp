#pragma once
// Simulation against data as curves over time, for the page of a verdict.
#include "diagnosis/data/verdict.hpp"
#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// Paths of the cells with the largest |z|, each path once, two of an observable, at most `most` of them; `effect`: the fit that the
/// verdict rests on, or null.
std::vector<GapCurve> gap_curves(const Responses& model, const Fitter& fitter, const Fit* effect, std::vector<GapCell> cells,
                                 std::size_t most = 4);

}  // namespace snag
