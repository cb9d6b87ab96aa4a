#pragma once
// Heading of the log of a run or of a check.
#include "base/case_file.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

/// Logs enough to know and repeat the run, what it assumes and what it leaves out. `file`: as the simulation has read it. Collective.
void log_heading(const Simulation& simulation, const CaseFile& file);

}  // namespace snag
