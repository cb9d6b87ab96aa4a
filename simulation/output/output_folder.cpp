#include "simulation/output/output_folder.hpp"

#include <mpi.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "parallel/session.hpp"
#include "simulation/setup/heading.hpp"
#include "simulation/setup/settings.hpp"

namespace snag {

namespace fs = std::filesystem;

namespace {

const char* const result_files[] = {"case.resolved.toml", "step.json", "summary.json", "log.txt", "report.html"};

/// A folder of results, and what the names of the files in it end with. What ends otherwise is not of a run.
struct ResultFolder {
  const char* name;
  std::vector<std::string> endings;
  bool is_made_first = true;  // by every run, before its results
};

const std::vector<ResultFolder>& result_folders() {
  static const std::vector<ResultFolder> folders{{"monitors", {".csv"}},
                                                 {"fields", {".vtu", ".pvtu", ".pvd"}},
                                                 {"rags", {".vtp", ".vtu", ".pvtu", ".pvd"}},
                                                 {"walls", {".vtp", ".pvd"}},
                                                 {"checkpoint", {".h5"}},
                                                 {"pictures", {".json", ".log", ".png", ".py", ".svg"}, false}};
  return folders;
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !(fs::is_directory(path, ignored) && fs::is_empty(path, ignored));
}

/// A file or a folder with something in it where a run writes its results; empty if there is none.
std::string taken_place(const fs::path& folder) {
  for (const char* name : result_files)
    if (is_there(folder / name)) return name;
  for (const ResultFolder& results : result_folders())
    if (is_there(folder / results.name)) return results.name;
  return "";
}

bool is_of_run(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "case.resolved.toml", ignored) || std::ranges::all_of(result_folders(), [&](const ResultFolder& results) {
           return !results.is_made_first || fs::is_directory(folder / results.name, ignored);
         });
}

/// Rank 0 only.
void refuse_results(const fs::path& folder, bool resume, bool overwrite) {
  if (resume) return;
  const std::string name = taken_place(folder);
  if (name.empty()) return;
  if (!is_of_run(folder))
    throw Error(ExitCode::usage, folder.string() + ": already has " + name +
                                     ", where a run writes its results, but is not the output folder of a run (it has no "
                                     "case.resolved.toml); nothing in it is changed: choose another --out");
  if (!overwrite)
    throw Error(ExitCode::usage, folder.string() + ": already has the results of a run (" + name +
                                     "), which will not be overwritten; choose another --out, or give --resume or --overwrite");
}

/// The results of a run; files that are none stay.
void remove_results(const fs::path& folder) {
  for (const char* name : result_files) fs::remove(folder / name);
  for (const ResultFolder& results : result_folders()) {
    const fs::path path = folder / results.name;
    if (!fs::is_directory(path) || fs::is_symlink(path)) continue;
    std::vector<fs::path> own;
    for (const auto& entry : fs::directory_iterator(path)) {
      fs::path file = entry.path();
      if (file.extension() == ".tmp") file.replace_extension();  // of a writer that was killed
      if (std::ranges::count(results.endings, file.extension().string()) > 0 && !entry.is_directory()) own.push_back(entry.path());
    }
    for (const fs::path& file : own) fs::remove(file);
    if (fs::is_empty(path)) fs::remove(path);
  }
}

/// results/NAME.
fs::path named_by(const CaseFile& file) {
  CaseSettings settings;
  file.root().table("case").read(settings.section().parameters);
  if (const fs::path name = settings.name; name.empty() || name == "." || name == ".." || name.has_parent_path())
    throw Error(ExitCode::usage,
                "[case] name = \"" + settings.name + "\" cannot name the output folder; give --out, or a name without \"/\"");
  return fs::path("results") / settings.name;
}

}  // namespace

OutputFolder OutputFolder::of(const CaseFile& file, const fs::path& out, bool resume, bool overwrite) {
  return {out.empty() ? named_by(file) : out, resume, overwrite};
}

OutputFolder::OutputFolder(fs::path folder, bool resume, bool overwrite) : path_(std::move(folder)) {
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) != 0) return;
    lock_.emplace(path_);
    refuse_results(path_, resume, overwrite);
  });
}

void OutputFolder::open(const Simulation& simulation, const CaseFile& file, bool resume) const {
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) prepare(!resume);
  });
  log::open(path_ / "log.txt", resume);
  log_heading(simulation, file);
}

/// Rank 0 only.
void OutputFolder::prepare(bool fresh) const {
  try {
    if (fresh) remove_results(path_);
    for (const ResultFolder& results : result_folders())
      if (std::string_view(results.name) != "pictures") fs::create_directories(path_ / results.name);
  } catch (const fs::filesystem_error& failure) {
    throw Error(ExitCode::io, path_.string() + ": cannot be written (" + failure.code().message() + "); choose another --out");
  }
}

}  // namespace snag
