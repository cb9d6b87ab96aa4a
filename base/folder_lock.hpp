#pragma once
// Only one process at a time writes to an output folder.
//
// The lock is flock(2) on the file `.lock` of the folder: it ends with the process, so that a killed run leaves none. The file says who has
// it. Both the file and folders made for it are removed at the end if nothing else came into them.
#include <filesystem>
#include <vector>

#include "base/open_file.hpp"

namespace snag {

class FolderLock {
 public:
  /// Makes the folder and locks it; throws Error(io) that names host and process of another holder. On a file system without locks it
  /// warns.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  void make_folder(const std::filesystem::path& folder);
  void acquire();

  std::filesystem::path folder_, path_;
  std::vector<std::filesystem::path> made_;  // folders, outer ones first
  OpenFile file_;
};

}  // namespace snag
