#pragma once
// Is a file a gmsh mesh? Others are recognised by their first bytes, so that the message can say how they become one.
#include <filesystem>

namespace snag {

/// Returns if the file begins as a gmsh mesh does. Throws Error(io) if it does not exist, is no file or is empty, Error(mesh) with the name
/// of the format and the way to convert it if it is something else.
void require_gmsh_format(const std::filesystem::path& file);

}  // namespace snag
