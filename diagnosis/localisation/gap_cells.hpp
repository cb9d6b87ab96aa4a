#pragma once
// Where the gap lies: cells (observable, quarter of the time, operating point) of E = S - D of the base model against
//
//   u_val^2 = u_num^2 + u_input^2 + u_D^2 + scatter_S/N_S                                              [ASME V&V 20]
//
// exact tests for counts and events, log-rank for censored times, energy distance for the scatter of repeats. The mean over a window hides
// what changes sign in it, and u_input counts the inputs anew in each cell; so rows are also tested with the inputs as all rows fit them,
// for anything and for what the effects of the verdict add (fitted_gap.hpp). The best test counts, times their number. False discovery rate
// 5 % in four levels: observable, region, point, window; a level at which the rows show the effects together, but no part of it alone does,
// is a cell of its own.
#include <vector>

#include "diagnosis/data/verdict.hpp"
#include "diagnosis/localisation/fitted_gap.hpp"

namespace snag {

/// Cells of the training points, judged by what the fit of no effects leaves and, if there is one, by what the chosen fit with effects
/// does, the best of `n_tried`.
std::vector<GapCell> gap_cells(Responses& model, const Fitter& fitter, const FittedGap& before, const FittedGap* after = nullptr,
                               int n_tried = 1);

}  // namespace snag
