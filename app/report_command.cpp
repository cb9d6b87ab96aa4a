// snag report DIR: one self-contained HTML file from the outputs of a run.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "app/report.hpp"
#include "base/log.hpp"
#include "parallel/session.hpp"

namespace snag {

Action add_report(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("report", "Write DIR/report.html, one self-contained file, from the outputs of a run");
  command->add_option("DIR", *folder, "Output folder of a run")->required();
  return [folder] {
    together(MPI_COMM_WORLD, [&] {
      if (rank_of(MPI_COMM_WORLD) == 0) write_report(*folder);
    });
    log::info("report: " + *folder + "/report.html");
    return ExitCode::ok;
  };
}

}  // namespace snag
