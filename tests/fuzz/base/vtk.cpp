// Polygons of a VTK file that a run wrote.
#include <unistd.h>

#include "base/atomic_file.hpp"
#include "base/vtk_reader.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace snag;

std::string triangle() {
  VtkPiece piece;
  piece.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  piece.connectivity = {0, 1, 2}, piece.offsets = {3};
  piece.point_arrays = {{"tension [N]", 1, {1, 2, 3}, true}};
  const auto file = std::filesystem::temp_directory_path() / ("snag_seed_" + std::to_string(getpid()) + ".vtp");
  write_vtk(file, VtkKind::polygons, piece);
  std::string content = file_text(file).value_or("");
  std::filesystem::remove(file);
  return content;
}

const fuzz::Registration polygons({"vtp", ".vtp", [] { return std::vector{triangle()}; }, [](const auto& file) { read_polygons(file); }});

}  // namespace
