#pragma once
// Trials of the step with the rag that enters first: from where it is put in until it touches a wall, before contacts make its motion
// chaotic, or for two revolutions.
#include <optional>
#include <vector>

#include "simulation/step/step_choice.hpp"

namespace snag {

class TrialCase;
class Simulation;

/// At the end of a step.
struct RagInstant {
  double duration = 0, path = 0, impulse = 0;  // since it was put in, s; of its centre of mass, m; of the water on it, magnitude, N s
};

struct RagTrial {
  int steps_per_revolution = 0;
  std::vector<RagInstant> course;

  double duration() const { return course.empty() ? 0 : course.back().duration; }
  /// Linear between the steps.
  RagInstant at(double duration) const;
};

enum RagQuantity : std::size_t { rag_path, rag_impulse };

/// When the first rag enters, s; zero: it is there from the start; none: no rag enters.
std::optional<double> first_entry(const Simulation& simulation);
/// Writes the state just before the rag enters, for try_rag(). Collective; throws Error(io).
void store_before_entry(const TrialCase& trial, const Simulation& simulation);
/// From that state, or from the start. Collective; throws Error.
RagTrial try_rag(const TrialCase& trial, int steps_per_revolution, bool from_start);

/// Path and impulse of each trial after the same time, that of the shortest one.
std::vector<StepTrial> at_same_time(const std::vector<RagTrial>& trials);

}  // namespace snag
