#pragma once
#include <filesystem>
#include <functional>

namespace snag {

/// Makes report.html of a folder with results. On one rank; throws Error(io).
using ReportWriter = std::function<void(const std::filesystem::path& folder)>;

}  // namespace snag
