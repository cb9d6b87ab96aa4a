#pragma once
// Reads back what vtk_file writes: sheets of rags (.vtp) and their times (.pvd).
#include <filesystem>
#include <string>
#include <vector>

#include "base/vtk_file.hpp"

namespace snag {

/// Points, polygons and arrays of a .vtp that write_vtk wrote (kind polygons). Throws Error(io) that says what is missing or broken.
VtkPiece read_polygons(const std::filesystem::path& file);

/// Values of an array whose name begins so ("velocity" or "velocity [m/s]"); throws Error(io) if there is none.
const std::vector<double>& array_named(const std::vector<VtkArray>& arrays, const std::string& name, const std::filesystem::path& file);

struct VtkInstant {
  double time = 0;  // s
  std::filesystem::path file;
};
/// Entries of a .pvd in order of time, files with the folder of the .pvd. Throws Error(io).
std::vector<VtkInstant> read_collection(const std::filesystem::path& file);

}  // namespace snag
