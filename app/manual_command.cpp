// snag manual: the manual of the case file, from the same records that read it.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "app/manual.hpp"
#include "parallel/standard_output.hpp"

namespace snag {

namespace {

Action add_manual(CLI::App& app) {
  const auto out = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "manual",
      "Print every table and key of the case file and of the other input files: unit, range, default, where it comes from, meaning");
  command->add_option("--out", *out, "File to write instead of printing");
  return [out] {
    write_or_print(*out, case_file_manual);
    return ExitCode::ok;
  };
}
const Command manual(100, add_manual);

}  // namespace

}  // namespace snag
