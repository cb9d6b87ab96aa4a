#pragma once
// Another program, run to its end.
#include <filesystem>
#include <string>
#include <vector>

namespace snag {

/// Runs command[0], found in PATH, with these arguments and without what ties this process to its MPI job; its exit code, or 128 + the
/// signal that ended it. `output`: file for what it prints; empty: it prints where this process does. Throws Error(io) with `remedy` if it
/// cannot be started.
int run_command(std::vector<std::string> command, const std::filesystem::path& output, const std::string& remedy);

}  // namespace snag
