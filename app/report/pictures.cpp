#include "app/report/pictures.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "app/report/html.hpp"
#include "app/report/render_script.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace snag {

namespace {

constexpr const char* time_limit = "900";        // s, of all pictures
constexpr const char* film_time_limit = "7200";  // s
constexpr int timed_out = 124;                   // exit code of timeout(1)

/// Runs a command with its output in a file; its exit code, or 128 + the signal that ended it. Throws Error(io) if it cannot be started.
int run(const std::vector<std::string>& command, const std::filesystem::path& output) {
  std::vector<char*> arguments;
  for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw Error(ExitCode::io, command[0] + ": cannot be started; install coreutils");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.substr(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
}

std::vector<Picture> listed(const std::filesystem::path& folder, const char* list) {
  std::vector<Picture> pictures;
  const auto entries = nlohmann::json::parse(file_text(folder / list).value_or(""), nullptr, false);
  if (!entries.is_array()) return pictures;
  for (const auto& entry : entries)
    pictures.push_back({folder / entry.value("file", ""), entry.value("group", ""), entry.value("caption", "")});
  return pictures;
}

/// Lets the script draw into DIR/pictures; what it listed there, and why it stopped early if it did.
Pictures drawn(const std::filesystem::path& dir, const char* list, const char* limit, const std::vector<std::string>& options) {
  Pictures pictures;
  const auto folder = dir / "pictures", output = folder / "render.log";
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  std::filesystem::remove(folder / list, failure);
  try {
    write_atomically(folder / "render.py", render_script);
    std::vector<std::string> command = {"timeout",
                                        "--kill-after=10",
                                        limit,
                                        "xvfb-run",
                                        "-a",
                                        "-s",
                                        "-screen 0 1280x1024x24",
                                        "/usr/bin/python3",
                                        (folder / "render.py").string(),
                                        dir.string(),
                                        "--out",
                                        folder.string()};
    command.insert(command.end(), options.begin(), options.end());
    const int exit_code = run(command, output);
    pictures.made = listed(folder, list);
    if (exit_code == timed_out)
      pictures.problem = std::string("drawing was stopped after ") + limit + " s";
    else if (exit_code != 0)
      pictures.problem = last_line(file_text(output).value_or("")) + " (exit code " + std::to_string(exit_code) + ")";
  } catch (const Error& error) {
    pictures.problem = error.what();
  }
  if (!pictures.problem.empty())
    pictures.problem += "; pictures need the packages python3-vtk9, python3-numpy, xvfb and xauth, and " + output.string() + " says more";
  return pictures;
}

}  // namespace

Pictures draw_pictures(const std::filesystem::path& dir) { return drawn(dir, "pictures.json", time_limit, {}); }

Pictures draw_film(const std::filesystem::path& dir) {
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(dir / "pictures", failure))
    if (entry.path().filename().string().starts_with("film_")) std::filesystem::remove(entry.path(), failure);
  return drawn(dir, "film.json", film_time_limit, {"--film"});
}

}  // namespace snag
