#pragma once
// Checkpoints of a run: when one is due, and the file.
#include <filesystem>
#include <functional>

#include "base/case_file.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

class Checkpoints {
 public:
  /// `folder`: of the run. All must outlive this object.
  Checkpoints(std::filesystem::path folder, const CaseFile& file, const Simulation& simulation);
  /// By simulated time, or by the wall clock of rank 0, since the last time that it was. Collective.
  bool due();
  /// The simulation and what `save_more` adds. Collective; throws Error(io).
  void write(const std::function<void(CheckpointWriter&)>& save_more) const;

 private:
  std::filesystem::path folder_;
  const CaseFile& file_;
  const Simulation& simulation_;
  double last_time_, last_wall_;  // s
};

}  // namespace snag
