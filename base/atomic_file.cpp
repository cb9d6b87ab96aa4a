#include "base/atomic_file.hpp"

#include <fstream>
#include <iterator>

#include "base/error.hpp"

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
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  std::error_code failure;
  if (out) {
    std::filesystem::rename(temporary, file, failure);
    if (!failure) return;
  }
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw Error(ExitCode::io, file.string() + ": cannot be written (" + std::to_string(content.size()) + " bytes" +
                                (failure ? ", " + failure.message() : "") +
                                "); the folder must exist, be writable and have room on its disk: free some or choose another --out");
}

}  // namespace snag
