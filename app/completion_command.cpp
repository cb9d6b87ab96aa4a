// snag completion: commands and options for bash, from the command line that reads them.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.hpp"
#include "parallel/standard_output.hpp"

namespace snag {

namespace {

/// "--help --out --set": the long names of the options, separated by blanks.
std::string option_names(const CLI::App& command) {
  std::string names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : " --") + name;
  }
  return names;
}

std::string completion_script(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands += command->get_name() + " ";
    cases += "    " + command->get_name() + ") options=\"" + option_names(*command) + "\" ;;\n";
  }
  return "# Completion of the commands and options of snag in bash, written by `snag completion`.\n"
         "_snag() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} options\n"
         "  case ${COMP_WORDS[1]} in\n" +
         cases +
         "  esac\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" = 1 ]; then\n"
         "    COMPREPLY=($(compgen -W \"" +
         commands + option_names(app) +
         "\" -- \"$word\"))\n"
         "  elif [[ $word == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
         "  fi\n"
         "}\n"
         "complete -o default -F _snag snag\n";
}

Action add_completion(CLI::App& app) {
  const auto out = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Print the completion of commands and options for bash: source <(snag completion)");
  command->add_option("--out", *out, "File to write instead of printing");
  return [&app, out] {
    write_or_print(*out, [&app] { return completion_script(app); });
    return ExitCode::ok;
  };
}
const Command completion(110, add_completion);

}  // namespace

}  // namespace snag
