#pragma once
// The output folder of a run: whether it may be written to, and its sub-folders. One run at a time has it.
#include <filesystem>
#include <optional>

#include "base/folder_lock.hpp"

namespace snag {

class OutputFolder {
 public:
  /// Locks the folder. Collective; throws Error(io) if another run has it, Error(usage) if it holds results that this run would replace
  /// without being asked to. Changes nothing.
  OutputFolder(std::filesystem::path folder, bool resume, bool overwrite);
  const std::filesystem::path& path() const { return path_; }
  /// Makes the folder and its sub-folders; removes the results of an earlier run if `fresh`. Rank 0 only; throws Error(io).
  void prepare(bool fresh) const;

 private:
  std::filesystem::path path_;
  std::optional<FolderLock> lock_;  // on rank 0
};

}  // namespace snag
