#pragma once
// A run of a case with a mesh for a diagnosis: a whole `snag run` in a folder of its own, kept there, on all ranks together.
#include <filesystem>
#include <string>
#include <vector>

#include "casework/case_run.hpp"
#include "simulation/setup/observe_settings.hpp"
#include "simulation/setup/prepared.hpp"

namespace snag {

/// Runs the case (its resolved text with overrides) in `folder`, or goes on with the run that is there, or only reads it if it is done.
/// Collective over all ranks; throws Error.
void run_in_folder(const std::string& case_text, const std::vector<std::string>& overrides, const std::filesystem::path& folder,
                   Prepared& prepared);

/// Answers from a finished run, of its first rag: places, velocities and pictures from its monitors, retention_time, recirculations, stuck,
/// exited from its summary; any other name is a column of a monitor (head, torque ...). At a time; without one its mean over the second
/// half of the time up to its last sample (of an angle the mean axis; silhouettes of a rag that is not there are left out), or, of what the
/// camera sees, over the time that the rag's centre is in the camera's window, where it has one. NaN where the run has no such value.
/// Throws Error(usage) for a name that no monitor has, Error(io).
std::vector<double> read_observables(const std::filesystem::path& folder, const std::vector<ObservableRequest>& asked,
                                     const ObserveSettings& camera);

}  // namespace snag
