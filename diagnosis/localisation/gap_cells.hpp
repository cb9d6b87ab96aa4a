#pragma once
// Where the gap lies: cells (observable, quarter of the time, operating point) of E = S - D of the base model against
//
//   u_val^2 = u_num^2 + u_input^2 + u_D^2 + scatter_S/N_S                                              [ASME V&V 20]
//
// exact tests for counts and events, log-rank for censored times, energy distance for the scatter of repeats, and a false discovery rate of
// 5 % in four levels: observable, region, point, window.
#include <vector>

#include "diagnosis/data/verdict.hpp"
#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// Cells of the training points.
std::vector<GapCell> gap_cells(Responses& model, const Fitter& fitter);

/// Marks cells as significant: an observable where its combined p (Simes) passes at rate 0.05 among the observables, a region within it
/// among its regions, a point within that among its points, a window among its windows. Then the onset: the first significant window of a
/// path with |z| > 3.
void mark_significant(std::vector<GapCell>& cells);

}  // namespace snag
