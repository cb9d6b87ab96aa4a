#pragma once
// What passes through a patch and what presses on it; sums over all ranks. Collective.
#include "solver/flow.hpp"

namespace snag {

/// Volume flow out of the domain, m3/s.
double patch_flow_rate(const Flow& flow, std::size_t patch);
/// Area mean of the pressure, Pa.
double patch_mean_pressure(const Flow& flow, std::size_t patch);

}  // namespace snag
