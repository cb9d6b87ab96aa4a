#pragma once
// Mesh of a benchmark, kept in its output folder.
#include <filesystem>
#include <string>
#include <vector>

namespace snag {

/// OUT/NAME.msh, made by `snag mesh` with these arguments (kind, then --set key=value ...) unless it is there. Collective; throws Error.
std::filesystem::path bench_mesh(const std::filesystem::path& out, const std::string& name, const std::vector<std::string>& arguments);

}  // namespace snag
