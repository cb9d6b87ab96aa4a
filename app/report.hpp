#pragma once
// The report of a run: DIR/report.html, one self-contained file with pictures, plots and numbers, for a reader who did not run it.
#include <filesystem>

namespace snag {

/// Makes DIR/report.html from whatever of the outputs of a run is there (summary.json, monitors, fields, rags, walls, resolved case, log).
/// Pictures need python3-vtk9 and Xvfb; without them the report says what is missing and why. Throws Error(io) if DIR holds no run.
/// One rank only.
void write_report(const std::filesystem::path& dir);

}  // namespace snag
