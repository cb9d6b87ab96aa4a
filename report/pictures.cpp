#include "report/pictures.hpp"

#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/child_process.hpp"
#include "base/error.hpp"
#include "report/html.hpp"
#include "report/render_script.hpp"

namespace snag {

namespace {

constexpr const char* time_limit = "900";        // s, of all pictures
constexpr const char* film_time_limit = "7200";  // s
constexpr int timed_out = 124;                   // exit code of timeout(1)

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

/// The results may be a stranger's: python reads no module and no start-up file of theirs (-I), nor does a program that looks into its
/// working directory.
std::vector<std::string> drawing_command(const std::filesystem::path& dir, const std::filesystem::path& folder, const char* limit) {
  const auto absolute = [](const std::filesystem::path& path) { return std::filesystem::absolute(path).string(); };
  return {"env",
          "--chdir=/",
          "timeout",
          "--kill-after=10",
          limit,
          "xvfb-run",
          "-a",
          "-s",
          "-screen 0 1280x1024x24",
          "/usr/bin/python3",
          "-I",
          absolute(folder / "render.py"),
          absolute(dir),
          "--out",
          absolute(folder)};
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
    std::vector<std::string> command = drawing_command(dir, folder, limit);
    command.insert(command.end(), options.begin(), options.end());
    const int exit_code = run_command(command, output, "install coreutils");
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

std::vector<Picture> pictures_there(const std::filesystem::path& dir) {
  std::vector<Picture> pictures = listed(dir / "pictures", "pictures.json");
  std::erase_if(pictures, [](const Picture& picture) { return !std::filesystem::is_regular_file(picture.file); });
  return pictures;
}

Pictures draw_pictures(const std::filesystem::path& dir) { return drawn(dir, "pictures.json", time_limit, {}); }

Pictures draw_film(const std::filesystem::path& dir) {
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(dir / "pictures", failure))
    if (entry.path().filename().string().starts_with("film_")) std::filesystem::remove(entry.path(), failure);
  return drawn(dir, "film.json", film_time_limit, {"--film"});
}

}  // namespace snag
