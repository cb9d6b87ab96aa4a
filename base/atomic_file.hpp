#pragma once
// Files that are read and replaced as a whole: a reader, or a run that was stopped, never sees half of one.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace snag {

/// Content of a file, or nothing if it cannot be read.
std::optional<std::string> file_text(const std::filesystem::path& file);

/// Write `content` under a temporary name beside `file`, then rename it. Throws Error(io); the old file is then still there.
void write_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace snag
