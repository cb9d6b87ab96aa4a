#pragma once
// Trials of the step with the water alone: it settles from the start of the case at a large step; then, from that state, each step is
// computed for the same number of revolutions.
//
// Rags that wait for their time do nothing to the water. Those that are there from the start are left where they are, and the water does
// not feel them: head and torque of the pump without rags decide.
#include <vector>

#include "simulation/step/step_choice.hpp"

namespace snag {

class TrialCase;

enum TrialQuantity : std::size_t { trial_head, trial_torque };  // m, N m

/// Revolutions until the water has settled, and of a trial.
inline constexpr int n_settling_least = 3, n_settling_most = 20, n_trial_revolutions = 3;

enum class RagEntry { none, at_start, later };

struct Settling {
  int revolutions = 0;
  double last_change = 0;  // of the mean head or torque from a revolution to the next, relative
  bool has_settled = false;
  RagEntry rag = RagEntry::none;  // the first one
};

/// Computes the water until its means change by less than twice the accuracy in two successive revolutions, and writes the state.
/// Where a rag enters later, it goes on until then and stores the state for try_rag(). Collective; throws Error.
Settling settle_water(const TrialCase& trial, int steps_per_revolution);

/// From the settled state, three revolutions. Collective; throws Error.
StepTrial try_water(const TrialCase& trial, int steps_per_revolution);

}  // namespace snag
