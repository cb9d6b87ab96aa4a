#pragma once
// [time] step = "auto": the trial that finds the step, from 6 degrees on by halves, and what it found.
#include "simulation/output/step_record.hpp"

namespace snag {

class TrialCase;
struct StepRequest;

/// Steps a revolution of the largest step that is tried: 6 degrees, the largest one that `snag check` does not warn of.
inline constexpr int fewest_trial_steps = 60;

/// Collective; throws Error: where the water diverges at the smallest step too, or the program is asked to stop.
StepRecord find_step(const TrialCase& trial);

/// What find_step() will do, and about how many steps it takes, for `snag check`.
std::string trial_in_words(const StepRequest& request);

}  // namespace snag
