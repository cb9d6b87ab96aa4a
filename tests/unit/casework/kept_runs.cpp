// The runs of a diagnosis are kept: the same on every rank, found again, taken from tables.
// ranks: 1 3
// long ranks: 2
#include <gtest/gtest.h>

#include <filesystem>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "tests/unit/casework/swung_sphere.hpp"

namespace snag {
namespace {

using KeptRuns = CaseSimulatorTest;

/// Requirement: all ranks have the same answers; equal requests run once; a new start with the same folder runs nothing again.
TEST_F(KeptRuns, KeepsRuns) {
  const auto cache = folder_ / "kept";
  std::vector<RunRequest> requests;
  for (const double theta : {0.1, 0.2, 0.3, 0.1, 0.0}) requests.push_back(with("added_mass", theta));
  std::vector<std::vector<double>> first;
  {
    CaseSimulator simulator(MPI_COMM_WORLD, experiment_, cache);
    for (const RunResult& result : simulator.run(requests)) first.push_back(result.values);
    EXPECT_EQ(simulator.n_runs(), 4);
    simulator.run(requests);
    EXPECT_EQ(simulator.n_runs(), 4);
  }
  EXPECT_EQ(first[0], first[3]);
  std::vector<double> mine = first[2], theirs = first[2];
  MPI_Bcast(theirs.data(), static_cast<int>(theirs.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
  EXPECT_EQ(mine, theirs);
  MPI_Barrier(MPI_COMM_WORLD);
  CaseSimulator again(MPI_COMM_WORLD, experiment_, cache);
  const auto results = again.run(requests);
  for (std::size_t i = 0; i < results.size(); ++i) EXPECT_EQ(results[i].values, first[i]);
  EXPECT_EQ(again.n_runs(), 0);
  EXPECT_EQ(again.n_used(), 4);
}

/// Requirement: runs of a table that the experiment names are not made again, whatever program made them; without a table of that name the
/// diagnosis does not begin.
TEST_F(KeptRuns, TakesRunsThatWereMadeElsewhere) {
  const std::vector<RunRequest> requests{with("added_mass", 0.1), with("added_mass", 0.2)};
  std::vector<std::vector<double>> first;
  {
    CaseSimulator simulator(MPI_COMM_WORLD, experiment_, folder_ / "here");
    for (const RunResult& result : simulator.run(requests)) first.push_back(result.values);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  experiment_.runs = folder_ / "elsewhere.tsv";
  EXPECT_THROW(CaseSimulator(MPI_COMM_WORLD, experiment_), Error);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    std::string text = file_text(folder_ / "here" / "runs.tsv").value();
    for (std::size_t line = 0; line < text.size(); line = text.find('\n', line) + 1) text.replace(line, 16, "another program!");
    write_atomically(experiment_.runs, text + "a line that was cut o");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  CaseSimulator simulator(MPI_COMM_WORLD, experiment_);
  const auto results = simulator.run(requests);
  for (std::size_t i = 0; i < results.size(); ++i) EXPECT_EQ(results[i].values, first[i]);
  EXPECT_EQ(simulator.n_runs(), 0);
  EXPECT_EQ(simulator.n_imported(), 2);
}

/// Requirement: a damaged table of runs is never taken for runs: the message names file and line, or the run that has too few values.
TEST_F(KeptRuns, DamagedTablesAreRefused) {
  {
    CaseSimulator simulator(MPI_COMM_WORLD, experiment_, folder_ / "sound");
    simulator.run(std::vector{with("added_mass", 0.1)});
  }
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string sound = file_text(folder_ / "sound" / "runs.tsv").value();
  experiment_.runs = folder_ / "damaged.tsv";
  const auto message_of = [&](const std::string& text) -> std::string {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_of(MPI_COMM_WORLD) == 0) write_atomically(experiment_.runs, text);
    MPI_Barrier(MPI_COMM_WORLD);
    try {
      CaseSimulator(MPI_COMM_WORLD, experiment_).run(std::vector{with("added_mass", 0.1)});
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::io);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message_of(sound), "");
  const std::size_t values = sound.find('\t', sound.find('\t') + 1) + 1, second = sound.find(',', values) + 1;
  std::string damaged = sound;
  damaged.replace(values, 1, "x");
  EXPECT_NE(message_of(sound + damaged).find("damaged.tsv:2: "), std::string::npos);
  EXPECT_NE(message_of(sound + "half a line\n").find("damaged.tsv:2: "), std::string::npos);
  damaged = sound;
  damaged.erase(values, second - values);
  EXPECT_NE(message_of(damaged).find("remove the line"), std::string::npos);
}

/// Requirement: a table of runs names keys by their first names, so that runs of an earlier version are found; an alternative may state
/// either name.
TEST_F(KeptRuns, TablesOfRunsHaveTheFirstNames) {
  const auto key_of = [&](const std::string& override_text, const std::filesystem::path& cache) {
    experiment_.alternatives = {{.effect = "operating_point", .meaning = "another frequency", .set = {override_text}, .at = {}}};
    CaseSimulator simulator(MPI_COMM_WORLD, experiment_, cache);
    values(simulator, with("operating_point", 1));
    MPI_Barrier(MPI_COMM_WORLD);
    return file_text(cache / "runs.tsv").value();
  };
  const std::string former = key_of("flow.omega_per_s=[30, 0, 0]", folder_ / "former"),
                    present = key_of("flow.angular_frequency_rad_s=[30, 0, 0]", folder_ / "present");
  EXPECT_NE(former.find("flow.omega_per_s=[30, 0, 0];"), std::string::npos) << former;
  EXPECT_EQ(present, former);
}

}  // namespace
}  // namespace snag
