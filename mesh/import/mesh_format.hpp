#pragma once
// Mesh files that no reader recognises: many formats show by their first bytes or their ending, so that the message can say how they become
// one that is read.
#include <filesystem>
#include <string>
#include <string_view>

namespace snag {

/// First bytes of a file, at most 4096. Throws Error(io) if it does not exist, is no file, is empty or cannot be opened, Error(mesh) for a
/// folder that is an OpenFOAM mesh.
std::string beginning_of_mesh(const std::filesystem::path& file);
/// Ending of the name in small letters, with its dot.
std::string ending_of(const std::filesystem::path& file);
/// Throws Error(mesh) with the name of the format and the way to convert it, as far as it is known, and the formats that are read.
[[noreturn]] void refuse_mesh_format(const std::filesystem::path& file, std::string_view beginning);

}  // namespace snag
