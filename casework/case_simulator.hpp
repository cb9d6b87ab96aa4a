#pragma once
// The simulator of a diagnosis over real runs: each request is a run of the point's case with other values, as `snag run` would do it.
//
// Cases without a mesh run in memory, each on one rank, the requests of a batch spread over the ranks. Cases with a mesh are whole runs,
// one after the other on all ranks, each in a folder of its own. Runs are cached: equal ones are done once, and with a folder they are
// there again when the diagnosis is started anew.
#include <mpi.h>

#include <filesystem>
#include <unordered_map>
#include <unordered_set>

#include "base/open_file.hpp"
#include "casework/case_run.hpp"
#include "casework/point_case.hpp"
#include "diagnosis/data/experiment.hpp"
#include "diagnosis/data/simulator.hpp"
#include "simulation/setup/prepared.hpp"

namespace snag {

class CaseSimulator final : public Simulator {
 public:
  /// From that of the experiment on: the runs of another point have others.
  static constexpr std::uint64_t seeds_of_a_point = 1000;

  /// `folder`: holds the runs that were done before by the same program, in runs.tsv and runs/, and takes those to come; empty: nothing is
  /// stored on disk, and cases with a mesh are refused. Runs of the table that the experiment names count whatever program made them.
  /// Collective over all ranks of the program; throws Error(usage, io) that names the case.
  CaseSimulator(MPI_Comm comm, const Experiment& experiment, const std::filesystem::path& folder = {});

  const std::vector<Effect>& effects() const override { return effects_; }
  const std::vector<Nuisance>& nuisances() const override { return nuisances_; }
  const std::vector<Slot>& slots(int point) const override { return points_[static_cast<std::size_t>(point)].slots; }
  std::vector<RunResult> run(std::span<const RunRequest> requests) override;
  double run_end(int point) const override { return points_[static_cast<std::size_t>(point)].base.end(); }
  bool restarts(int point) const override { return points_[static_cast<std::size_t>(point)].base.restarts(); }
  int n_runs() const override { return n_runs_; }
  int n_used() const override { return static_cast<int>(used_.size()); }
  int n_imported() const override;
  FailedRuns failed() const override { return failed_; }
  /// What a run changes of the base case of its point. Throws Error(usage) for a seed that is one of another point.
  CaseChange change_of(const RunRequest& request) const;
  /// The case of a run with all its keys and its time step, to be read from any folder. Collective over all ranks; throws Error.
  std::string resolved_case(const RunRequest& request);
  /// Whether an uncertain input is of the cases; else it is a calibration of the measurement.
  bool is_of_case(const std::string& nuisance) const;

 private:
  struct Point {
    PointCase base;
    std::vector<Slot> slots;
    std::vector<ObservableRequest> asked;
    std::string of_case, fingerprint;  // of base case and program; of the base case and the slots
  };
  struct Job {
    std::string key;
    std::string settings;  // what of the base case is changed
    const RunRequest* request;
    CaseChange change;
    std::optional<CaseChange> outside{};  // of its gate; absent: it has none
  };
  void find_nuisances(const Experiment& experiment);
  Job job_of(const RunRequest& request) const;
  void run_portion(std::span<const Job* const> fresh);
  RunResult run_serial(const Job& job) const;
  RunResult run_collective(const Job& job) const;
  bool is_whole_run(const Job& job) const { return points_[static_cast<std::size_t>(job.request->point)].base.is_whole_run(); }
  RunResult as_observed(const RunRequest& request, const CaseChange& change, RunResult raw) const;
  void open_cache(const std::filesystem::path& file);
  void import_runs(const std::filesystem::path& file);
  void store(const std::string& key, const RunResult& result);

  MPI_Comm comm_;
  mutable Prepared prepared_;
  mutable FlowCache store_;
  std::filesystem::path folder_;
  std::vector<Observable> observables_;
  double picture_size_;  // m
  std::uint64_t first_seed_;
  std::vector<Point> points_;
  std::vector<Effect> effects_;
  std::vector<Nuisance> nuisances_;
  std::string program_;  // its fingerprint; empty: nothing is stored on disk
  std::unordered_map<std::string, RunResult> cached_;
  std::unordered_set<std::string> used_;      // keys of the runs that were asked for
  std::unordered_set<std::string> imported_;  // of those of the table that the experiment names
  std::unordered_set<std::string> failed_keys_;
  FailedRuns failed_;
  OpenFile cache_;  // open on rank 0
  int n_runs_ = 0;
};

}  // namespace snag
