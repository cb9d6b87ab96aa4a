#include "mesh/import/mesh_format.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/quotation.hpp"
#include "mesh/import/mesh_reader.hpp"

namespace snag {
namespace {

struct Format {
  const char* name;
  const char* remedy;
};

// Gmsh opens geometry and the meshes of its neighbours itself; a solver's own meshes of polyhedra it does not.
constexpr const char* mesh_geometry =
    "it is geometry without cells: open it with gmsh, name volumes and surfaces (Physical Volume, Physical Surface), mesh in three "
    "dimensions and save as .msh";
constexpr const char* convert_mesh =
    "open it with gmsh, name volumes and surfaces (Physical Volume, Physical Surface) and save it as .msh 4.1: gmsh FILE -save -format "
    "msh41 -o MESH.msh";
constexpr const char* mesh_again =
    "gmsh cannot open it: export the mesh as CGNS, UNV or VTK from the program that made it and save that from gmsh as .msh, or mesh the "
    "geometry with gmsh";
constexpr Format step{"STEP", mesh_geometry}, iges{"IGES", mesh_geometry}, stl{"STL", mesh_geometry}, vtk{"VTK", convert_mesh},
    unv{"I-deas universal (UNV)", convert_mesh}, cgns{"CGNS", convert_mesh}, hdf5{"HDF5 (CGNS or MED)", convert_mesh},
    nastran{"Nastran bulk data", convert_mesh}, su2{"SU2", convert_mesh}, abaqus{"Abaqus", convert_mesh}, fluent{"Fluent mesh", mesh_again},
    openfoam{"OpenFOAM polyMesh", mesh_again}, old_gmsh{"gmsh 1.0", convert_mesh},
    geo{"gmsh geometry", "mesh it: gmsh -3 FILE -format msh41 -o MESH.msh"};

bool is_binary_stl(std::string_view head, std::uintmax_t size) {
  if (head.size() < 84) return false;
  std::uint32_t n_triangles = 0;
  std::memcpy(&n_triangles, head.data() + 80, sizeof n_triangles);
  return n_triangles > 0 && size == 84 + 50 * std::uintmax_t{n_triangles};
}

/// By what stands at the beginning.
std::optional<Format> format_of_content(std::string_view head, std::uintmax_t size) {
  constexpr std::array<std::pair<std::string_view, Format>, 15> beginnings{{{"ISO-10303-21", step},
                                                                            {"solid", stl},
                                                                            {"# vtk", vtk},
                                                                            {"<?xml", vtk},
                                                                            {"<VTKFile", vtk},
                                                                            {"\x89HDF", hdf5},
                                                                            {"ADF Database", cgns},
                                                                            {"(", fluent},
                                                                            {"SOL ", nastran},
                                                                            {"CEND", nastran},
                                                                            {"BEGIN BULK", nastran},
                                                                            {"NDIME", su2},
                                                                            {"*HEADING", abaqus},
                                                                            {"*Heading", abaqus},
                                                                            {"$NOD", old_gmsh}}};
  const std::size_t first = std::min(head.find_first_not_of(" \t\r\n"), head.size());
  const std::string_view word = head.substr(first);
  if (head.find("FoamFile") != std::string_view::npos) return openfoam;
  if (is_binary_stl(head, size)) return stl;
  if (word.starts_with("-1") && word.substr(0, 40).find("\n") != std::string_view::npos) return unv;
  if (head.size() > 4 && head.substr(4).starts_with("ADF Database")) return cgns;
  for (const auto& [beginning, format] : beginnings)
    if (word.starts_with(beginning)) return format;
  return {};
}

/// By the ending of the name, where the content says nothing.
std::optional<Format> format_of_name(const std::filesystem::path& file) {
  constexpr std::array<std::pair<std::string_view, Format>, 19> endings{{{".step", step},
                                                                         {".stp", step},
                                                                         {".igs", iges},
                                                                         {".iges", iges},
                                                                         {".stl", stl},
                                                                         {".vtk", vtk},
                                                                         {".vtu", vtk},
                                                                         {".unv", unv},
                                                                         {".cgns", cgns},
                                                                         {".med", hdf5},
                                                                         {".bdf", nastran},
                                                                         {".nas", nastran},
                                                                         {".su2", su2},
                                                                         {".inp", abaqus},
                                                                         {".cas", fluent},
                                                                         {".geo", geo},
                                                                         {".geo_unrolled", geo},
                                                                         {".brep", step},
                                                                         {".foam", openfoam}}};
  const std::string ending = ending_of(file);
  for (const auto& [known, format] : endings)
    if (ending == known) return format;
  return {};
}

[[noreturn]] void throw_format(const std::string& name, const Format& format) {
  throw Error(ExitCode::mesh,
              name + ": is a file of the format " + format.name + ", Snag reads " + readable_mesh_formats() + "; " + format.remedy);
}

void require_file(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  std::error_code failure;
  const fs::file_status status = fs::status(file, failure);
  if (status.type() == fs::file_type::not_found)
    throw Error(ExitCode::io, file.string() + ": the mesh file does not exist; check the path");
  if (fs::is_directory(status) && (fs::exists(file / "faces", failure) || fs::exists(file / "polyMesh", failure)))
    throw_format(file.string(), openfoam);
  if (!fs::is_regular_file(status))
    throw Error(ExitCode::io, file.string() + ": is a " + (fs::is_directory(status) ? "folder" : "device or pipe") +
                                  ", not a file; name the mesh file itself");
  if (fs::file_size(file, failure) == 0 || failure)
    throw Error(ExitCode::io, file.string() + ": the mesh file is empty or cannot be opened; check it and its permissions");
}

}  // namespace

std::string beginning_of_mesh(const std::filesystem::path& file) {
  require_file(file);
  std::ifstream stream(file, std::ios::binary);
  std::string head(4096, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (!stream && !stream.eof()) throw Error(ExitCode::io, file.string() + ": the mesh file cannot be opened; check its permissions");
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void refuse_mesh_format(const std::filesystem::path& file, std::string_view beginning) {
  std::error_code ignored;
  auto format = format_of_content(beginning, std::filesystem::file_size(file, ignored));
  if (!format) format = format_of_name(file);
  if (format) throw_format(file.string(), *format);
  const std::string_view word = beginning.substr(std::min(beginning.find_first_not_of(" \t\r\n"), beginning.size()));
  throw Error(ExitCode::mesh, file.string() + ": begins with \"" + shortened(word.substr(0, 40)) +
                                  "\" and is of no format that Snag reads: " + readable_mesh_formats() +
                                  "; open the mesh with gmsh and save it as .msh 2.2 or 4.1");
}

}  // namespace snag
