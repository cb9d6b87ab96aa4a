#pragma once
// Errors that a user sees: what is wrong, the value, the rule, the remedy; and the exit code of the program.
#include <stdexcept>
#include <string>

namespace snag {

/// Exit codes of every command, the same on every rank.
enum class ExitCode : int { ok = 0, usage = 2, mesh = 3, diverged = 4, invariant = 5, io = 6, stopped = 7 };

/// Thrown with a message of the form "where: what (value), rule; remedy". The command line prints it and exits with the code.
struct Error : std::runtime_error {
  Error(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

}  // namespace snag
