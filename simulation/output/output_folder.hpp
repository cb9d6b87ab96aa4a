#pragma once
// The output folder of a run: whether it may be written to, and its sub-folders. One run at a time has it.
#include <filesystem>
#include <optional>

#include "base/case_file.hpp"
#include "base/folder_lock.hpp"

namespace snag {

class Simulation;

class OutputFolder {
 public:
  /// `out`, or, where it is empty, results/NAME of the case. Locks it, as the constructor does. Throws Error(usage) for a name that cannot
  /// name a folder.
  static OutputFolder of(const CaseFile& file, const std::filesystem::path& out, bool resume, bool overwrite);
  /// Locks the folder. Collective; throws Error(io) if another run has it, Error(usage) if it holds results that this run would replace
  /// without being asked to. Changes nothing.
  OutputFolder(std::filesystem::path folder, bool resume, bool overwrite);
  const std::filesystem::path& path() const { return path_; }
  /// Makes the folder and its sub-folders, removing the results of an earlier run unless this one resumes, and opens the log with its
  /// heading. `file`: as the simulation has read it. Collective; throws Error(io).
  void open(const Simulation& simulation, const CaseFile& file, bool resume) const;

 private:
  void prepare(bool fresh) const;
  std::filesystem::path path_;
  std::optional<FolderLock> lock_;  // on rank 0
};

}  // namespace snag
