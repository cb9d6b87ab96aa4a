#include "casework/diagnose_case.hpp"

#include <mpi.h>

#include <memory>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/folder_lock.hpp"
#include "base/progress.hpp"
#include "casework/case_simulator.hpp"
#include "diagnosis/diagnose.hpp"
#include "parallel/session.hpp"

namespace snag {

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
  const Verdict verdict = diagnose(experiment, simulator, {.progress = [&](const std::string& stage, double done) {
                                     if (progress) progress->update(done, stage);
                                   }});
  if (progress) progress->finish();
  on_all_ranks(world, [&] {
    if (first) write_atomically(options.out / "verdict.json", verdict_json(verdict));
  });
  return verdict;
}

}  // namespace snag
