#pragma once
// What a case says of its step, and the case with a step that is a number.
#include <string>
#include <vector>

#include "simulation/setup/settings.hpp"

namespace snag {

class CaseFile;

struct StepRequest {
  TimeSettings time;
  std::string where;  // "case.toml:12: [time]"
  double period = 0;  // of a revolution at full speed, s; 0: no rotor
  bool has_pump = false, slides = false;

  bool is_auto() const { return time.step_is_auto(); }
  /// Steps a revolution that follow from degrees_per_step; 0 without it.
  int steps_of_degrees() const;
  /// Of "auto" without degrees.
  double accuracy() const;
  double step(int steps_per_revolution) const { return period / steps_per_revolution; }
  /// End of the run with this step, s: as given, or the next whole step.
  double end_at(double step) const;
  /// Throws Error(usage) if the keys contradict each other, or the case lacks what they need.
  void check() const;
};

StepRequest read_step_request(const CaseFile& file);

/// Overrides of the case with this step, s; the end is the next whole step.
std::vector<std::string> with_step(const StepRequest& request, const std::vector<std::string>& overrides, double step);

}  // namespace snag
