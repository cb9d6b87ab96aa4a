#pragma once
// The subcommands: one file each, which registers itself, adds its options to the command line and returns what is to be done when the
// user asks for it.
#include <functional>

#include "base/error.hpp"

namespace CLI {
class App;
}

namespace snag {

using Action = std::function<ExitCode()>;

/// `const Command registered(10, add_run);` registers a subcommand. `place`: where help lists it; no two are the same.
struct Command {
  Command(int place, Action (*add)(CLI::App& app));
};

}  // namespace snag
