#pragma once
// The subcommands: each file adds its own to the command line and returns what is to be done when the user asks for it.
#include <functional>

#include "base/error.hpp"

namespace CLI {
class App;
}

namespace snag {

using Action = std::function<ExitCode()>;

Action add_run(CLI::App& app);
Action add_check(CLI::App& app);
Action add_mesh(CLI::App& app);
Action add_study(CLI::App& app);
Action add_calibrate(CLI::App& app);
Action add_bench(CLI::App& app);
Action add_observe(CLI::App& app);
Action add_report(CLI::App& app);
Action add_diagnose(CLI::App& app);
Action add_manual(CLI::App& app);
Action add_completion(CLI::App& app);

}  // namespace snag
