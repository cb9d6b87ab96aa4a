// snag run and snag check.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "report/report.hpp"
#include "simulation/run.hpp"

namespace snag {

namespace {

void add_case_options(CLI::App& command, RunOptions& options) {
  command.add_option("CASE", options.case_file, "Case file (.toml)")->required();
  command.add_option("--set", options.overrides, "Replace a value of the case: section.key=value; may be given several times")
      ->allow_extra_args(false);
}

Action add_run(CLI::App& app) {
  struct Options : RunOptions {
    bool dry_run = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("run", "Run a case: water, rags, or both; writes fields, monitors, summary.json and report.html");
  add_case_options(*command, *options);
  command->add_option("--out", options->out, "Output folder (default results/NAME of the case)");
  command->add_flag("--dry-run", options->dry_run, "Only check, as `snag check` does");
  auto* resume = command->add_flag("--resume", options->resume, "Continue from the newest valid checkpoint of the output folder");
  command->add_flag("--overwrite", options->overwrite, "Replace the results of an earlier run in the output folder")->excludes(resume);
  options->write_report = write_report;
  return [options] { return options->dry_run ? check_case(*options) : run_case(*options); };
}
const Command run(10, add_run);

Action add_check(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "check", "Check a case without a time step: keys, mesh, conditions, stable steps, kernel width against cells, cost");
  add_case_options(*command, *options);
  return [options] { return check_case(*options); };
}
const Command check(20, add_check);

}  // namespace

}  // namespace snag
