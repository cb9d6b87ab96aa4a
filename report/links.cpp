#include "report/links.hpp"

#include "base/error.hpp"
#include "base/quotation.hpp"

namespace snag {
namespace {

namespace fs = std::filesystem;

bool lies_in(const fs::path& path, const fs::path& dir) {
  return std::mismatch(dir.begin(), dir.end(), path.begin(), path.end()).first == dir.end();
}

}  // namespace

void require_no_outward_links(const fs::path& dir) {
  std::error_code failure;
  const fs::path inside = fs::canonical(dir, failure);
  for (fs::recursive_directory_iterator entry(inside, fs::directory_options::skip_permission_denied, failure), end;
       !failure && entry != end; entry.increment(failure)) {
    if (!entry->is_symlink(failure)) continue;
    const fs::path target = fs::canonical(entry->path(), failure);
    if (failure || !lies_in(target, inside))
      throw Error(ExitCode::io,
                  shortened(entry->path().string()) + ": is a symbolic link to " +
                      shortened(fs::read_symlink(entry->path(), failure).string()) +
                      ", a report neither reads nor writes outside of the folder of the results; put the file itself in its place "
                      "or remove the link");
  }
  if (failure)
    throw Error(ExitCode::io, shortened(dir.string()) + ": the folder cannot be read (" + failure.message() + "); check its permissions");
}

}  // namespace snag
