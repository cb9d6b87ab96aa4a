#include "casework/diagnose_case.hpp"

#include <mpi.h>

#include <memory>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/folder_lock.hpp"
#include "base/progress.hpp"
#include "casework/case_simulator.hpp"
#include "casework/improved_case.hpp"
#include "diagnosis/diagnose.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

/// Draws and improved cases of another verdict, which an earlier start left in the folder, are removed.
void write_results(const std::filesystem::path& folder, const Experiment& experiment, const Verdict& verdict,
                   const std::vector<ImprovedCase>& improved) {
  write_improved_cases(folder, experiment, improved);
  std::filesystem::remove(folder / "posterior.json");
  if (!verdict.posterior.variables.empty()) write_atomically(folder / "posterior.json", posterior_json(verdict.posterior));
  write_atomically(folder / "verdict.json", verdict_json(verdict));
}

}  // namespace

Verdict diagnose_file(const DiagnoseOptions& options) {
  const MPI_Comm world = MPI_COMM_WORLD;
  const bool first = rank_of(world) == 0;
  Experiment experiment;
  std::optional<FolderLock> lock;
  on_all_ranks(world, [&] {
    experiment = read_experiment(options.file);
    if (first) lock.emplace(options.out);
  });
  CaseSimulator simulator(world, experiment, options.keep_runs ? options.out : std::filesystem::path());
  std::unique_ptr<Progress> progress;
  if (first && !options.quiet) progress = std::make_unique<Progress>(experiment.name, 1);
  Verdict verdict = diagnose(experiment, simulator, {.progress = [&](const std::string& stage, double done) {
                               if (progress) progress->update(done, stage);
                             }});
  if (progress) progress->finish();
  const std::vector<ImprovedCase> improved = improved_cases(simulator, experiment, verdict);
  on_all_ranks(world, [&] {
    if (first) write_results(options.out, experiment, verdict, improved);
  });
  return verdict;
}

}  // namespace snag
