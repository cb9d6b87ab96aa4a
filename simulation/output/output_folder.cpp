#include "simulation/output/output_folder.hpp"

#include <mpi.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "parallel/session.hpp"
#include "simulation/setup/heading.hpp"
#include "simulation/setup/settings.hpp"

namespace snag {

namespace fs = std::filesystem;

namespace {

const char* const result_names[] = {
    "case.resolved.toml", "step.json", "summary.json", "log.txt", "report.html", "monitors", "fields", "rags", "walls",
    "checkpoint",         "pictures"};

/// Rank 0 only.
void refuse_results(const fs::path& folder, bool resume, bool overwrite) {
  std::error_code ignored;
  if (resume || overwrite || !fs::exists(folder, ignored)) return;
  for (const char* name : {"summary.json", "checkpoint", "monitors"}) {
    if (fs::exists(folder / name, ignored))
      throw Error(ExitCode::usage, folder.string() + ": already has the results of a run (" + name +
                                       "), which will not be overwritten; choose another --out, or give --resume or --overwrite");
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
    if (fresh) {
      for (const char* name : result_names) fs::remove_all(path_ / name);
    }
    for (const char* name : {"monitors", "fields", "rags", "walls", "checkpoint"}) fs::create_directories(path_ / name);
  } catch (const fs::filesystem_error& failure) {
    throw Error(ExitCode::io, path_.string() + ": cannot be written (" + failure.code().message() + "); choose another --out");
  }
}

}  // namespace snag
