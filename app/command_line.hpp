#pragma once
// The command line as a whole: `argv` in, exit code out, the same on every rank.
#include "base/error.hpp"

namespace snag {

class Session;

int run_command_line(int argc, char** argv, const Session& session);

/// After an error: a rank that fails alone leaves the others waiting in some exchange; gives them a moment to fail too, else ends them with
/// the same code. Returns where all have failed.
void leave_together(ExitCode code);

}  // namespace snag
