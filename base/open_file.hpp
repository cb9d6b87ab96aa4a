#pragma once
// A file by its descriptor, for what streams cannot do: bring it to the disk, lock it, see that it was removed while it is open.
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace snag {

class OpenFile {
 public:
  OpenFile() = default;
  /// `flags` as of open(2); a file that is made is readable by all. Children of the process do not inherit it. Throws Error(io).
  OpenFile(std::filesystem::path path, int flags);
  OpenFile(OpenFile&& other) noexcept : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(path_, other.path_), std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~OpenFile();
  int descriptor() const { return descriptor_; }
  /// All of it or Error(io).
  void write(std::string_view content);
  /// Returns when the disk has what was written; throws Error(io).
  void sync() const;
  /// No folder names this file any more: what is written to it is lost.
  bool is_removed() const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Brings a closed file, or the names in a folder, to the disk. Throws Error(io).
void sync_to_disk(const std::filesystem::path& path);

}  // namespace snag
