// snag study STUDY.toml --out DIR: sweeps and ensembles of a case.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "report/report.hpp"
#include "report/study_results.hpp"
#include "simulation/study.hpp"

namespace snag {

namespace {

Action add_study(CLI::App& app) {
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* command = app.add_subcommand("study", "Run a case with several values of its keys; writes a table and plots of the results");
  command->add_option("STUDY", options->study_file, "Study file (.toml)")->required();
  command->add_option("--out", options->out, "Output folder (default results/NAME of the study); finished runs in it are not repeated");
  command->add_flag("--dry-run", options->dry_run, "Only list the runs");
  options->write_report = write_report;
  options->write_results = write_study_results;
  return [options] { return run_study(*options); };
}
const Command study(40, add_study);

}  // namespace

}  // namespace snag
