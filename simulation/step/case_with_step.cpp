#include "simulation/step/case_with_step.hpp"

#include <mpi.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "simulation/step/find_step.hpp"
#include "simulation/step/trial_case.hpp"

namespace snag {

namespace {

StepRequest checked_request(const CaseFile& file) {
  StepRequest request = read_step_request(file);
  request.check();
  return request;
}

/// By degrees_per_step.
StepRecord step_of_degrees(const StepRequest& request) {
  const int n = request.steps_of_degrees();
  return {.step = request.step(n), .steps_per_revolution = n};
}

void warn_of_idle_accuracy(const StepRequest& request) {
  if (request.time.step_accuracy)
    log::warning(request.where + " step_accuracy = " + number_text(*request.time.step_accuracy) +
                 " has no effect: step_s = " + number_text(request.time.step) + " is given; step = \"auto\" finds the step anew");
}

}  // namespace

CaseWithStep case_with_step(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                            const std::filesystem::path& output, Prepared& prepared) {
  CaseFile file = CaseFile::read(case_file, overrides);
  const StepRequest request = checked_request(file);
  if (!request.is_auto()) {
    warn_of_idle_accuracy(request);
    return {std::move(file), {}};
  }
  StepRecord found =
      request.time.degrees_per_step ? step_of_degrees(request) : find_step(TrialCase(case_file, overrides, request, output, prepared));
  if (const double end = request.end_at(found.step); end > request.time.end)
    found.notes.push_back("the run ends at " + number_text(end) + " s, the next whole step after " + number_text(request.time.end) + " s");
  return {CaseFile::read(case_file, with_step(request, overrides, found.step)), found};
}

CaseWithStep case_with_stored_step(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                                   const std::filesystem::path& output) {
  CaseFile file = CaseFile::read(case_file, overrides);
  const StepRequest request = checked_request(file);
  if (!request.is_auto()) return {std::move(file), {}};
  const std::optional<StepRecord> found = read_step_record(output);
  if (!found)
    throw Error(ExitCode::usage, request.where + " step = \"auto\": " + (output / "step.json").string() +
                                     " is missing, it must hold the step that the run found; give step_s of case.resolved.toml instead");
  return {CaseFile::read(case_file, with_step(request, overrides, found->step)), found};
}

CaseToCheck case_with_first_step(const std::filesystem::path& case_file, const std::vector<std::string>& overrides) {
  CaseFile file = CaseFile::read(case_file, overrides);
  const StepRequest request = checked_request(file);
  if (!request.is_auto()) {
    warn_of_idle_accuracy(request);
    return {std::move(file), ""};
  }
  if (request.time.degrees_per_step) {
    const StepRecord found = step_of_degrees(request);
    return {CaseFile::read(case_file, with_step(request, overrides, found.step)), step_in_words(found)};
  }
  return {CaseFile::read(case_file, with_step(request, overrides, request.step(fewest_trial_steps))), trial_in_words(request)};
}

void say_and_store(const StepRecord& found, const std::filesystem::path& output, bool resume) {
  log::info(step_in_words(found));
  if (!found.is_reached)
    log::warning("[time] step = \"auto\": the accuracy of " + rounded(100 * *found.accuracy) +
                 " % is not reached, see the log; give more [flow] n_outer_correctors, or a larger step_accuracy");
  if (resume) return;
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) write_step_record(output, found);
  });
}

}  // namespace snag
