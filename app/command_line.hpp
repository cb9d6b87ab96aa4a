#pragma once
// The command line as a whole: `argv` in, exit code out, the same on every rank.
namespace snag {

class Session;

int run_command_line(int argc, char** argv, const Session& session);

}  // namespace snag
