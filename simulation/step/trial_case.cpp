#include "simulation/step/trial_case.hpp"

#include "base/error.hpp"
#include "base/log.hpp"
#include "parallel/session.hpp"
#include "parallel/stop_request.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

TrialCase::TrialCase(std::filesystem::path case_file, std::vector<std::string> overrides, StepRequest request,
                     const std::filesystem::path& output, Prepared& prepared)
    : case_file_(std::move(case_file)),
      folder_(output / "step_trial"),
      overrides_(std::move(overrides)),
      request_(std::move(request)),
      prepared_(prepared),
      stop_(std::make_unique<StopRequest>(MPI_COMM_WORLD, output)) {}

TrialCase::~TrialCase() {
  std::error_code ignored;
  if (rank_of(MPI_COMM_WORLD) == 0) std::filesystem::remove_all(folder_, ignored);
}

std::unique_ptr<Simulation> TrialCase::simulation(int steps_per_revolution) const {
  const log::Silence silence;
  const CaseFile file = CaseFile::read(case_file_, with_step(request_, overrides_, request_.step(steps_per_revolution)));
  return std::make_unique<Simulation>(file, MPI_COMM_WORLD, Simulation::Stored{}, nullptr, &prepared_);
}

void TrialCase::stop_if_asked() const {
  if (stop_->asked())
    throw Error(ExitCode::stopped, "stopped on request (" + stop_->reason() +
                                       ") in the trial that finds [time] step = \"auto\"; nothing is written yet: start the run again, or "
                                       "give step_ms");
}

}  // namespace snag
