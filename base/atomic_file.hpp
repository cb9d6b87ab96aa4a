#pragma once
// Files that are replaced as a whole: a reader, or a run that was stopped, never sees half of one.
#include <filesystem>
#include <string_view>

namespace snag {

/// Write `content` under a temporary name beside `file`, then rename it. Throws Error(io); the old file is then still there.
void write_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace snag
