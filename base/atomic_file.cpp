#include "base/atomic_file.hpp"

#include <fcntl.h>

#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "base/open_file.hpp"

namespace snag {

std::optional<std::string> file_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) return {};
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (in.bad()) return {};
  return text;
}

void write_atomically(const std::filesystem::path& file, std::string_view content) {
  auto temporary = file;
  temporary += ".tmp";
  std::error_code failure;
  try {
    OpenFile out(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    out.write(content);
    out.sync();  // before the new name: after a power cut the file is the old or the new one, never an empty one
    std::filesystem::rename(temporary, file, failure);
    if (failure) throw Error(ExitCode::io, file.string() + ": cannot be replaced (" + failure.message() + "); choose another --out");
    sync_to_disk(file.has_parent_path() ? file.parent_path() : ".");
  } catch (const Error&) {
    std::filesystem::remove(temporary, failure);
    throw;
  }
}

}  // namespace snag
