#include "base/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.hpp"

namespace snag {

namespace {

/// The environment without that of an MPI job: a program that uses MPI would try to join it.
std::vector<char*> own_environment() {
  constexpr std::array<std::string_view, 4> of_job{"OMPI_", "PMIX_", "PRTE_", "ORTE_"};
  std::vector<char*> environment;
  for (char** entry = environ; *entry; ++entry)
    if (std::none_of(of_job.begin(), of_job.end(), [&](std::string_view prefix) { return std::string_view(*entry).starts_with(prefix); }))
      environment.push_back(*entry);
  environment.push_back(nullptr);
  return environment;
}

}  // namespace

int run_command(std::vector<std::string> command, const std::filesystem::path& output, const std::string& remedy) {
  std::vector<char*> arguments, environment = own_environment();
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (!output.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  }
  pid_t child = 0;
  const int failure = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw Error(ExitCode::io, command[0] + ": cannot be started; " + remedy);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace snag
