#include "base/atomic_file.hpp"

#include <fcntl.h>

#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/open_file.hpp"
#include "base/words.hpp"

namespace snag {

std::optional<std::string> file_text(const std::filesystem::path& file) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure)) return {};  // a device or a pipe may never end
  if (const auto size = std::filesystem::file_size(file, failure); !failure && static_cast<double>(size) > physical_memory() / 2)
    throw Error(ExitCode::io, file.string() + ": has " + std::to_string(size) + " bytes, a file must fit into half of the memory of " +
                                  number_text(physical_memory()) + " bytes; is it the right one?");
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
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
