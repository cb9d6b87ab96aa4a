#pragma once
// What the trials of a step have in common: the case with another step, in a folder that is removed at the end.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "simulation/step/step_request.hpp"

namespace snag {

class Simulation;
class StopRequest;
struct Prepared;

class TrialCase {
 public:
  /// `output`: the folder of the run. Collective.
  TrialCase(std::filesystem::path case_file, std::vector<std::string> overrides, StepRequest request, const std::filesystem::path& output,
            Prepared& prepared);
  ~TrialCase();
  TrialCase(const TrialCase&) = delete;
  TrialCase& operator=(const TrialCase&) = delete;

  const StepRequest& request() const { return request_; }
  /// Before its start. Nothing of it is logged: the run says the same. Collective.
  std::unique_ptr<Simulation> simulation(int steps_per_revolution) const;
  /// Of the trial, for checkpoints.
  const std::filesystem::path& folder() const { return folder_; }
  /// Throws Error(stopped) if the program was asked to stop. Collective.
  void stop_if_asked() const;

 private:
  std::filesystem::path case_file_, folder_;
  std::vector<std::string> overrides_;
  StepRequest request_;
  Prepared& prepared_;
  std::unique_ptr<StopRequest> stop_;
};

}  // namespace snag
