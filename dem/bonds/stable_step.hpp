#pragma once
// Largest stable step of leapfrog for the bonds of a flat piece at rest, by the coefficients of its law.
#include <string>

#include "dem/particles/rag.hpp"
#include "dem/particles/step_rates.hpp"

namespace snag {

struct StepLimit {
  double step = 0;     // s
  std::string reason;  // "bonds of rag 1: normal stiffness lengthwise"
};

/// Limit by the bonds of one piece; `damping_rate`: further damping of the translation (drag: slope/m), 1/s. Infinite for a piece without
/// bonds and damping. For a stretched or bent cloth stiffnesses shift by some ten per cent: use it with a safety factor.
StepLimit stable_bond_step(const Rag& rag, double damping_rate = 0);

/// Rates of the bonds of one piece, to which those of contacts are added; their step is a little below stable_bond_step.
StepRates bond_rates(const Rag& rag, double damping_rate = 0);

}  // namespace snag
