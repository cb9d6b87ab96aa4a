#pragma once
// The report of a run: DIR/report.html, one self-contained file with pictures, plots and numbers, for a reader who did not run it.
#include <filesystem>
#include <string>

namespace snag {

/// Makes DIR/report.html from whatever of the outputs of a run is there (summary.json, monitors, fields, rags, walls, resolved case, log).
/// Pictures need python3-vtk9 and Xvfb; without them the report says what is missing and why. Throws Error(io) if DIR holds no run.
/// One rank only.
void write_report(const std::filesystem::path& dir);

struct Film {
  std::size_t n_pictures = 0;
  std::string problem;  // why some or all are missing; empty if all were made
};

/// Draws DIR/pictures/film_0001.png and so on: the view of the report's instants, a picture for each time at which the rags were written,
/// from the first at which there is one. One rank only.
Film make_film(const std::filesystem::path& dir);

}  // namespace snag
