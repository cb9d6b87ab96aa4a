#include "base/open_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"

namespace snag {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw Error(ExitCode::io, path.string() + ": " + what + " (" + std::strerror(errno) +
                                "); the folder must exist, be writable and have room on its disk: free some or choose another --out");
}

}  // namespace

OpenFile::OpenFile(std::filesystem::path path, int flags)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), flags | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail(path_, "cannot be opened");
}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OpenFile::write(std::string_view content) {
  while (!content.empty()) {
    const ssize_t done = ::write(descriptor_, content.data(), content.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(path_, "cannot be written");
    content.remove_prefix(static_cast<std::size_t>(done));
  }
}

void OpenFile::sync() const {
  // Some file systems cannot flush a folder and say EINVAL: they keep its names in order by themselves.
  if (fsync(descriptor_) != 0 && errno != EINVAL) fail(path_, "could not be flushed to the disk");
}

bool OpenFile::is_removed() const {
  struct stat status {};
  return fstat(descriptor_, &status) != 0 || status.st_nlink == 0;
}

void sync_to_disk(const std::filesystem::path& path) { OpenFile(path, O_RDONLY).sync(); }

}  // namespace snag
