#include "simulation/output/field_output.hpp"

#include <array>

#include "mesh/skewness.hpp"
#include "mesh/wall_surface.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"
#include "solver/fields/rotating_zone.hpp"

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

FieldOutput::FieldOutput(const FieldWriter& writer, SeriesPlace place, const Mesh& mesh, bool single_precision)
    : mesh_(mesh), single_precision_(single_precision), piece_(grid_of(mesh)) {
  place.name = "water", place.kind = VtkKind::unstructured_grid;
  series_ = writer.series_of_pieces(place, mesh.comm);
  const std::vector<int> skew = skew_cells(mesh_), corner = corner_cells(mesh_);
  if (sum(mesh_.comm, static_cast<std::int64_t>(skew.size() + corner.size())) == 0) return;
  skew_ = {"skew [1]", 1, std::vector<double>(static_cast<std::size_t>(mesh_.n_cells)), true};
  for (const int c : corner) skew_->values[static_cast<std::size_t>(c)] = 2;
  for (const int c : skew) skew_->values[static_cast<std::size_t>(c)] = 1;
}

void FieldOutput::write(const Flow& flow) {
  const int n = mesh_.n_cells, rank = rank_of(mesh_.comm);
  const auto owned = [&](const std::string& name, const auto& values) {
    return vtk_array(name, std::span(values).first(static_cast<std::size_t>(n)), single_precision_);
  };
  const auto of_rags = [&](const std::string& name, auto values) {  // a copy, zero without rags
    values.resize(static_cast<std::size_t>(n));
    return owned(name, values);
  };
  piece_.cell_arrays = {owned("velocity [m/s]", flow.velocity),
                        owned("pressure [Pa]", flow.pressure),
                        of_rags("solid_fraction [1]", flow.solid_fraction),
                        of_rags("reaction [N/m3]", flow.reaction),
                        {"rank [1]", 1, std::vector<double>(n, rank), true}};
  if (!flow.eddy_viscosity.empty())
    for (const auto& [name, values] :
         {std::pair{"turbulent_kinetic_energy [m2/s2]", &flow.turbulent_kinetic_energy},
          std::pair{"dissipation_rate [m2/s3]", &flow.dissipation_rate}, std::pair{"eddy_viscosity [m2/s]", &flow.eddy_viscosity}})
      piece_.cell_arrays.push_back(owned(name, *values));
  for (const ModelField& field : flow.model_fields) piece_.cell_arrays.push_back(owned(field.name + " [" + field.unit + "]", field.values));
  if (flow.rotating_zone) {
    piece_.points = mesh_.node;  // they may have turned
    VtkArray turning{"turning [1]", 1, {}, true};
    for (int c = 0; c < n; ++c) turning.values.push_back(mesh_.cell_zone[c] == flow.rotating_zone->zone());
    piece_.cell_arrays.push_back(std::move(turning));
  }
  if (skew_) piece_.cell_arrays.push_back(*skew_);
  piece_.field_arrays = {{"TimeValue", 1, {flow.time}, false}};
  series_->add(flow.time, flow.time_step, piece_);
}

WallOutput::WallOutput(std::shared_ptr<const FieldWriter> writer, SeriesPlace place, const Flow& flow)
    : writer_(std::move(writer)), place_(std::move(place)) {
  place_.name = "walls", place_.kind = VtkKind::polygons;
  if (flow.rotating_zone) series_ = writer_->series(place_);
}

void WallOutput::initial(const Flow& flow) {
  if (series_) return write(flow);
  const VtkPiece walls = walls_of(flow);
  on_all_ranks(flow.mesh.comm, [&] {
    if (rank_of(flow.mesh.comm) == 0) writer_->write(place_.folder, place_.name, place_.kind, walls);
  });
}

void WallOutput::write(const Flow& flow) {
  if (!series_) return;
  const VtkPiece walls = walls_of(flow);
  on_all_ranks(flow.mesh.comm, [&] {
    if (rank_of(flow.mesh.comm) == 0) series_->add(flow.time, flow.time_step, walls);
  });
}

VtkPiece WallOutput::walls_of(const Flow& flow) const {
  const Mesh& mesh = flow.mesh;
  std::vector<std::string> names;
  for (const Patch& patch : mesh.patches) names.push_back(patch.name);
  const WallSurface surface = wall_surface(mesh, names);
  const auto of_faces = [&](const char* name, const std::vector<double>& values) {
    std::vector<double> mine;
    for (const Patch& patch : mesh.patches)
      for (int f = patch.first; f < patch.end(); ++f) mine.push_back(values[f - mesh.n_interior]);
    const std::vector<double> all = gathered(mesh.comm, mine);
    VtkArray array{name, 1, {}, true};
    for (const WallTriangle& triangle : surface.triangles) array.values.push_back(all[static_cast<std::size_t>(triangle.face)]);
    return array;
  };
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
  if (series_) {
    std::vector<double> turning;
    for (int f = mesh.n_interior; f < mesh.n_faces; ++f) turning.push_back(mesh.cell_zone[mesh.owner[f]] == flow.rotating_zone->zone());
    piece.cell_arrays.push_back(of_faces("turning [1]", turning));
    piece.cell_arrays.push_back(of_faces("pressure [Pa]", flow.boundary_pressure));
    if (sum(mesh.comm, static_cast<std::int64_t>(flow.y_plus.size())) > 0) piece.cell_arrays.push_back(of_faces("y_plus [1]", flow.y_plus));
    piece.field_arrays = {{"TimeValue", 1, {flow.time}, false}};
  }
  return piece;
}

}  // namespace snag
