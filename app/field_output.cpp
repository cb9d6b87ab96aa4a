#include "app/field_output.hpp"

#include <array>

#include "base/words.hpp"
#include "mesh/wall_surface.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

std::uint8_t vtk_type(CellShape shape) {
  switch (shape) {
    case CellShape::tetrahedron:
      return 10;
    case CellShape::hexahedron:
      return 12;
    case CellShape::prism:
      return 13;
    case CellShape::pyramid:
      return 14;
  }
  return 0;
}

VtkPiece grid_of(const Mesh& mesh) {
  VtkPiece piece;
  piece.points = mesh.node;
  piece.connectivity.assign(mesh.cell_node.begin(), mesh.cell_node.end());
  for (int c = 0; c < mesh.n_cells; ++c) {
    piece.offsets.push_back(mesh.cell_node_start[c + 1]);
    piece.types.push_back(vtk_type(mesh.cell_shape[c]));
  }
  return piece;
}

}  // namespace

FieldOutput::FieldOutput(std::filesystem::path folder, const Mesh& mesh, bool single_precision, bool resume, double from_time)
    : folder_(std::move(folder)),
      mesh_(mesh),
      single_precision_(single_precision),
      piece_(grid_of(mesh)),
      collection_(folder_ / "water.pvd", resume, from_time) {}

void FieldOutput::write(const Flow& flow) {
  const int n = mesh_.n_cells, rank = rank_of(mesh_.comm), size = size_of(mesh_.comm);
  const auto owned = [&](const std::string& name, const auto& values) {
    return vtk_array(name, std::span(values).first(static_cast<std::size_t>(n)), single_precision_);
  };
  piece_.cell_arrays = {owned("velocity [m/s]", flow.velocity),
                        owned("pressure [Pa]", flow.pressure),
                        owned("solid_fraction [1]", flow.solid_fraction),
                        owned("reaction [N/m3]", flow.reaction),
                        {"rank [1]", 1, std::vector<double>(n, rank), true}};
  if (!flow.eddy_viscosity.empty())
    for (const auto& [name, values] :
         {std::pair{"turbulent_kinetic_energy [m2/s2]", &flow.turbulent_kinetic_energy},
          std::pair{"dissipation_rate [m2/s3]", &flow.dissipation_rate}, std::pair{"eddy_viscosity [m2/s]", &flow.eddy_viscosity}})
      piece_.cell_arrays.push_back(owned(name, *values));
  piece_.field_arrays = {{"TimeValue", 1, {flow.time}, false}};
  const std::string stem = numbered("water", flow.time_step);
  std::vector<std::string> pieces;
  for (int r = 0; r < size; ++r) pieces.push_back(stem + "_" + std::to_string(r) + ".vtu");
  together(mesh_.comm, [&] {
    write_vtk(folder_ / pieces[rank], VtkKind::unstructured_grid, piece_);
    if (rank != 0) return;
    write_parallel_vtk(folder_ / (stem + ".pvtu"), VtkKind::unstructured_grid, piece_, pieces);
    collection_.add(flow.time, stem + ".pvtu");
  });
}

void write_walls(const std::filesystem::path& file, const Mesh& mesh) {
  std::vector<std::string> names;
  for (const Patch& patch : mesh.patches) names.push_back(patch.name);
  const WallSurface surface = wall_surface(mesh, names);
  together(mesh.comm, [&] {
    if (rank_of(mesh.comm) != 0) return;
    VtkPiece piece;
    VtkArray part{"patch [1]", 1, {}, true};
    for (const WallTriangle& triangle : surface.triangles) {
      for (const Vec3& node : triangle.node) {
        piece.connectivity.push_back(static_cast<std::int64_t>(piece.points.size()));
        piece.points.push_back(node);
      }
      piece.offsets.push_back(static_cast<std::int64_t>(piece.points.size()));
      part.values.push_back(triangle.part);
    }
    piece.cell_arrays.push_back(std::move(part));
    write_vtk(file, VtkKind::polygons, piece);
  });
}

}  // namespace snag
