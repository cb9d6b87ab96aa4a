#include "base/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/atomic_file.hpp"
#include "base/date.hpp"
#include "base/error.hpp"
#include "base/log.hpp"

namespace snag {

namespace {

std::string own_name() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(getpid()) + " on host " + host.data() + " since " + date();
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : folder_(folder), path_(folder / ".lock") {
  make_folder(folder_);
  acquire();
}

FolderLock::~FolderLock() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);  // before the lock ends: nobody else has this file yet
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) std::filesystem::remove(*made, ignored);  // fails unless empty
}

void FolderLock::make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  for (auto missing = folder; !missing.empty() && !std::filesystem::exists(missing, failure); missing = missing.parent_path())
    made_.insert(made_.begin(), missing);
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(ExitCode::io, folder.string() + ": cannot be written (" + failure.message() + "); choose another --out");
}

void FolderLock::acquire() {
  do {
    file_ = OpenFile(path_, O_RDWR | O_CREAT);
    while (flock(file_.descriptor(), LOCK_EX | LOCK_NB) != 0) {
      if (errno == EINTR) continue;
      if (errno == EWOULDBLOCK) {
        const std::string holder = file_text(path_).value_or("");
        throw Error(ExitCode::io, folder_.string() + ": is in use by " + (holder.empty() ? "another process" : holder) +
                                      "; wait until that has ended, or choose another --out");
      }
      log::warning(folder_.string() + ": its file system has no locks (" + std::strerror(errno) +
                   "); nothing prevents a second run from writing to this folder");
      return;
    }
  } while (file_.is_removed());  // by its holder, between the two calls
  if (ftruncate(file_.descriptor(), 0) == 0) file_.write(own_name());
}

}  // namespace snag
