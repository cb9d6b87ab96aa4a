#include "app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/build_info.hpp"
#include "app/command.hpp"
#include "base/explained.hpp"
#include "base/log.hpp"
#include "base/version.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "parallel/standard_output.hpp"

namespace snag {

namespace {

constexpr const char* about =
    "Snag predicts how wet wipes and rags travel through and clog wastewater pumps.\n\n"
    "A first run:   snag run cases/rag-in-channel/case.toml --out results/first\n"
    "Look at it:    results/first/report.html in a browser, results/first/fields and rags in ParaView\n"
    "On 4 ranks:    mpirun -n 4 snag run CASE.toml\n\n"
    "Exit codes: 0 ok, 2 usage or case file, 3 mesh, 4 diverged, 5 conserved quantity lost, 6 input/output, 7 stopped on request "
    "(checkpoint "
    "written)";

/// The functions that add them, by their places in the help.
std::map<int, Action (*)(CLI::App&)>& commands() {
  static std::map<int, Action (*)(CLI::App&)> all;
  return all;
}

/// A misspelt subcommand gets the nearest known one.
void explain_unknown_command(int argc, char** argv, const std::vector<std::string>& known) {
  if (argc < 2 || argv[1][0] == '-') return;
  const std::string word = argv[1];
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  const std::string near = nearest_name(word, known);
  throw Error(ExitCode::usage,
              "unknown command \"" + word + "\"; known: " + joined(known) + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

int parse_and_act(int argc, char** argv, const Session& session) {
  CLI::App app(about, "snag");
  app.set_version_flag("--version", std::string("snag ") + version_number + " (" + version_git + ")\n" + version_citation);
  bool build_info = false;
  app.add_flag("--build-info", build_info, "Compiler, flags and libraries of this program");
  std::vector<std::pair<std::string, Action>> actions;
  std::vector<std::string> known;
  for (const auto& [place, add] : commands()) {
    Action action = add(app);
    known.push_back(app.get_subcommands([](const CLI::App*) { return true; }).back()->get_name());
    actions.emplace_back(known.back(), std::move(action));
  }
  app.require_subcommand(0, 1);  // a path that is named like a command, such as a folder "run", is no second one
  explain_unknown_command(argc, argv, known);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& parse) {
    std::ostringstream out, err;
    const int code = app.exit(parse, out, err);
    print(out.str());
    if (session.rank() == 0) std::cerr << err.str();
    return code == 0 ? 0 : static_cast<int>(ExitCode::usage);
  }
  if (build_info) {
    print(snag::build_info() + "\n");
    return 0;
  }
  for (const auto& [name, action] : actions) {
    if (app.got_subcommand(name)) return static_cast<int>(action());
  }
  print(app.help());
  return static_cast<int>(ExitCode::usage);
}

}  // namespace

Command::Command(int place, Action (*add)(CLI::App& app)) {
  if (!commands().emplace(place, add).second) throw std::logic_error("two commands have the place " + std::to_string(place));
}

int run_command_line(int argc, char** argv, const Session& session) {
  try {
    return parse_and_act(argc, argv, session);
  } catch (const std::exception& failure) {
    const Error error = explained(failure);
    log::error(error.what());
    log::flush();
    leave_together(error);
    return static_cast<int>(error.code);
  }
}

}  // namespace snag
