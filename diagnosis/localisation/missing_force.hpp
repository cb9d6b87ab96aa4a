#pragma once
// The force that is missing, by time, place and speed: with W the test functions of the weak form (weak_form.hpp) over a measured path of a
// position and e what a fit leaves of it, measured less simulated, with the inputs as fitted (fitted_gap.hpp),
//
//   a = W e,   cov(a) = W cov(e) W^T,
//
// the mean missing acceleration about the times of the test functions: force over mass, N/kg, where the mass holds what moves with the
// piece.
#include <vector>

#include "diagnosis/data/verdict.hpp"
#include "diagnosis/localisation/fitted_gap.hpp"

namespace snag {

/// Of the training points whose paths have seven rows or more, in order of point and time. `after`: of the fit that the verdict rests on;
/// null: there is none.
std::vector<MissingForce> missing_forces(const Responses& model, const FittedGap& before, const FittedGap* after);

}  // namespace snag
