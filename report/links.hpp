#pragma once
// Symbolic links in a folder of results.
#include <filesystem>

namespace snag {

/// A report reads and writes inside the folder of the results, wherever they come from. Throws Error(io) that names the first symbolic link
/// in it that leads out of it, or nowhere.
void require_no_outward_links(const std::filesystem::path& dir);

}  // namespace snag
