#pragma once
// The case of a run with its step as a number: as it is given, or as [time] step = "auto" finds it.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "simulation/output/step_record.hpp"

namespace snag {

struct Prepared;

struct CaseWithStep {
  CaseFile file;
  std::optional<StepRecord> found;  // absent: the case gives its step
};

/// Finds the step of a run that begins; for an accuracy by a trial, which needs `output` for its checkpoints. Collective; throws Error.
CaseWithStep case_with_step(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                            const std::filesystem::path& output, Prepared& prepared);

/// The same of a run that goes on: the step is that which it found. Collective; throws Error.
CaseWithStep case_with_stored_step(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                                   const std::filesystem::path& output);

struct CaseToCheck {
  CaseFile file;           // with the largest step that a trial looks at
  std::string about_step;  // what a run will do, for the log; empty: the case gives its step
};
CaseToCheck case_with_first_step(const std::filesystem::path& case_file, const std::vector<std::string>& overrides);

/// The record to the log and, unless the run goes on, to its folder. Collective; throws Error(io).
void say_and_store(const StepRecord& found, const std::filesystem::path& output, bool resume);

}  // namespace snag
