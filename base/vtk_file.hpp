#pragma once
// Files for ParaView: XML VTK with appended binary arrays, compressed by zlib; collections (.pvd) over time.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/vec3.hpp"

namespace snag {

/// One array of a VTK file: name with its unit ("velocity [m/s]"), 1, 3 or 9 components.
struct VtkArray {
  std::string name;
  int components = 1;
  std::vector<double> values;  // written as Float32 if `single`, else Float64
  bool single = true;
};

/// Numbers or vectors as an array.
VtkArray vtk_array(const std::string& name, std::span<const double> values, bool single = true);
VtkArray vtk_array(const std::string& name, std::span<const Vec3> values, bool single = true);

/// Unstructured grid (.vtu) or poly data (.vtp) of one rank.
struct VtkPiece {
  std::vector<Vec3> points;
  std::vector<std::int64_t> connectivity, offsets;  // cells or polygons: end of each in connectivity
  std::vector<std::uint8_t> types;                  // VTK cell types; .vtu only
  std::vector<VtkArray> point_arrays, cell_arrays;
  std::vector<VtkArray> field_arrays;  // FieldData: time, rotor angle
};

enum class VtkKind { unstructured_grid, polygons, vertices, lines };  // the last three are .vtp

/// Write one piece to one file (through a temporary name, so that a reader never sees half a file). Throws Error(io).
void write_vtk(const std::filesystem::path& file, VtkKind kind, const VtkPiece& piece);
/// Index file (.pvtu/.pvtp) over the pieces of all ranks, with the same arrays as `example`.
void write_parallel_vtk(const std::filesystem::path& file, VtkKind kind, const VtkPiece& example,
                        const std::vector<std::string>& piece_files);

/// A time series for ParaView, rewritten after each entry. On a resume entries after `from_time` are dropped, like the lines of a Series;
/// an entry takes the place of those of its time or later, so that nothing is twice or missing whatever is written first.
class VtkCollection {
 public:
  VtkCollection(std::filesystem::path file, bool resume, double from_time = 0);
  void add(double time, const std::string& relative_file);

 private:
  std::filesystem::path file_;
  std::vector<std::pair<double, std::string>> entries_;
};

}  // namespace snag
