#pragma once
// Whether a gap was born in its window or inherited from before: the base model goes on from the measured state at the entry of the window,
// and the cell is judged again.
//
//   E' = S' - D,   u'^2 = u_num^2 + u_input'^2 + u_D^2 + u_S^2 + u_state^2
//
// S': the run whose centre and velocity are moved to the measured ones where the window begins; u_input': its derivatives; u_state: what
// the uncertainty of that state makes of it. A calibration shifts state and data alike and is left out. What the base model's state is off
// by there is a parabola through the differences about the entry, by least squares; of the velocity, where it is measured, a line through
// its own.
#include <vector>

#include "diagnosis/data/verdict.hpp"
#include "diagnosis/fitting/fit.hpp"

namespace snag {

/// Fills restart_z and origin of the significant cells of paths but the first in time, where runs can go on from a measured state and
/// enough samples of a coordinate or velocity lie about the entry; as many as [budget] still allows. A cell is born where its restart_z is
/// significant at a false discovery rate of 5 %, inherited where it is not and less than half of the gap is left, else undecided.
/// Collective.
void judge_origins(Responses& model, const Fitter& fitter, std::vector<GapCell>& cells);

}  // namespace snag
