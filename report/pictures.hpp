#pragma once
// The pictures of a report, drawn off-screen by a process of its own (Python with VTK): a failure there costs pictures, never the report.
#include <filesystem>
#include <string>
#include <vector>

namespace snag {

struct Picture {
  std::filesystem::path file;
  std::string group;  // instants of the rags, "rag": from the side, "pump": from the inlet of a pump; "scale": their colour bars; "path":
                      // of the rags' centroids; "speed": water and walls
  std::string caption;
};

struct Pictures {
  std::vector<Picture> made;
  std::string problem;  // why some or all are missing, with the remedy; empty if all were made
};

/// Draws what fields, rags and walls of the run's folder hold into DIR/pictures; the script stays there for views of one's own.
Pictures draw_pictures(const std::filesystem::path& dir);

/// What an earlier report drew of the run, as far as it is still there.
std::vector<Picture> pictures_there(const std::filesystem::path& dir);

/// Draws DIR/pictures/film_0001.png and so on, one for each instant at which the rags were written; those of an earlier film are removed.
/// Only `made` and `problem` are set.
Pictures draw_film(const std::filesystem::path& dir);

}  // namespace snag
