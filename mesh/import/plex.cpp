#include "mesh/import/plex.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "mesh/shapes.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr std::array shapes_in_order{CellShape::tetrahedron, CellShape::hexahedron, CellShape::prism, CellShape::pyramid};

DMPolytopeType polytope(CellShape shape) {
  switch (shape) {
    case CellShape::tetrahedron:
      return DM_POLYTOPE_TETRAHEDRON;
    case CellShape::hexahedron:
      return DM_POLYTOPE_HEXAHEDRON;
    case CellShape::prism:
      return DM_POLYTOPE_TRI_PRISM;
    default:
      return DM_POLYTOPE_PYRAMID;
  }
}

/// Cells and their vertices, which are numbered behind the cells.
void add_cells(DM dm, const MeshParts& whole, const std::vector<PetscInt>& order) {
  const auto n_cells = static_cast<PetscInt>(order.size()), n_nodes = static_cast<PetscInt>(whole.node.size());
  check_petsc(DMPlexSetChart(dm, 0, n_cells + n_nodes), "DMPlexSetChart");
  check_petsc(DMCreateLabel(dm, "celltype"), "DMCreateLabel");  // otherwise DMPlex guesses the types, from cones that are not there yet
  for (PetscInt c = 0; c < n_cells; ++c) {
    const CellShape shape = whole.shape[order[c]];
    check_petsc(DMPlexSetConeSize(dm, c, n_nodes_of(shape)), "DMPlexSetConeSize");
    check_petsc(DMPlexSetCellType(dm, c, polytope(shape)), "DMPlexSetCellType");
  }
  for (PetscInt v = n_cells; v < n_cells + n_nodes; ++v) check_petsc(DMPlexSetCellType(dm, v, DM_POLYTOPE_POINT), "DMPlexSetCellType");
  check_petsc(DMSetUp(dm), "DMSetUp");
  for (PetscInt c = 0; c < n_cells; ++c) {
    std::array<PetscInt, 8> cone{};
    const int start = whole.cell_start[order[c]], n = n_nodes_of(whole.shape[order[c]]);
    for (int i = 0; i < n; ++i) cone[i] = n_cells + whole.cell_node[start + i];
    if (n == n_nodes_of(CellShape::prism)) std::swap(cone[1], cone[2]), std::swap(cone[4], cone[5]);  // VTK's order to gmsh's
    check_petsc(DMPlexReorderCell(dm, c, cone.data()), "DMPlexReorderCell");                          // gmsh's to DMPlex's
    check_petsc(DMPlexSetCone(dm, c, cone.data()), "DMPlexSetCone");
  }
}

void add_faces_and_edges(DM& dm) {
  DM interpolated = nullptr;
  check_petsc(DMPlexSymmetrize(dm), "DMPlexSymmetrize");
  check_petsc(DMPlexStratify(dm), "DMPlexStratify");
  check_petsc(DMPlexInterpolate(dm, &interpolated), "DMPlexInterpolate");
  DMDestroy(&dm);
  dm = interpolated;
}

/// The point one dimension up that all of these bound, with a cone of this size: the edge of two vertices, the face of its edges. -1: none.
PetscInt common_support(DM dm, const std::vector<PetscInt>& points, PetscInt cone_size) {
  PetscInt n_joins = 0, common = -1;
  const PetscInt* joins = nullptr;
  const auto n = static_cast<PetscInt>(points.size());
  check_petsc(DMPlexGetJoin(dm, n, points.data(), &n_joins, &joins), "DMPlexGetJoin");
  for (PetscInt i = 0; i < n_joins; ++i) {
    PetscInt size = 0;
    check_petsc(DMPlexGetConeSize(dm, joins[i], &size), "DMPlexGetConeSize");
    if (size == cone_size) common = joins[i];
  }
  check_petsc(DMPlexRestoreJoin(dm, n, points.data(), &n_joins, &joins), "DMPlexRestoreJoin");
  return common;
}

/// The face of these vertices, which go around it. By its edges: DMPlexGetFullJoin visits all cells at each vertex, which took a fifth of
/// an import.
PetscInt face_of(DM dm, const std::vector<PetscInt>& vertices) {
  const std::size_t n = vertices.size();
  std::vector<PetscInt> edges;
  for (std::size_t i = 0; i < n; ++i) edges.push_back(common_support(dm, {vertices[i], vertices[(i + 1) % n]}, 2));
  const bool has_edges = std::ranges::none_of(edges, [](PetscInt edge) { return edge < 0; });
  const PetscInt face = has_edges ? common_support(dm, edges, static_cast<PetscInt>(n)) : -1;
  if (face < 0)
    throw Error(ExitCode::mesh,
                "a face of a named surface belongs to no cell; mesh volume and surface together");  // require_fitting_cells has the place
  return face;
}

void add_names(DM dm, const MeshParts& whole, const std::vector<PetscInt>& order) {
  for (const char* label : {zone_label, patch_label}) check_petsc(DMCreateLabel(dm, label), "DMCreateLabel");
  const auto n_cells = static_cast<PetscInt>(order.size());
  for (PetscInt c = 0; c < n_cells; ++c)
    if (whole.zone[order[c]] >= 0) check_petsc(DMSetLabelValue(dm, zone_label, c, whole.zone[order[c]]), "DMSetLabelValue");
  DMLabel patches = nullptr;
  check_petsc(DMGetLabel(dm, patch_label, &patches), "DMGetLabel");
  for (std::size_t b = 0; b < whole.boundary_patch.size(); ++b) {
    std::vector<PetscInt> vertices;
    for (int i = whole.boundary_start[b]; i < whole.boundary_start[b + 1]; ++i) vertices.push_back(n_cells + whole.boundary_node[i]);
    check_petsc(DMLabelSetValue(patches, face_of(dm, vertices), whole.boundary_patch[b]), "DMLabelSetValue");
  }
}

void add_positions(DM dm, const MeshParts& whole, PetscInt n_cells) {
  const auto n_nodes = static_cast<PetscInt>(whole.node.size());
  PetscSection section = nullptr;
  Vec coordinates = nullptr;
  PetscScalar* x = nullptr;
  check_petsc(DMSetCoordinateDim(dm, 3), "DMSetCoordinateDim");
  check_petsc(DMGetCoordinateSection(dm, &section), "DMGetCoordinateSection");
  check_petsc(PetscSectionSetNumFields(section, 1), "PetscSectionSetNumFields");
  check_petsc(PetscSectionSetFieldComponents(section, 0, 3), "PetscSectionSetFieldComponents");
  check_petsc(PetscSectionSetChart(section, n_cells, n_cells + n_nodes), "PetscSectionSetChart");
  for (PetscInt v = n_cells; v < n_cells + n_nodes; ++v) PetscSectionSetDof(section, v, 3), PetscSectionSetFieldDof(section, v, 0, 3);
  check_petsc(PetscSectionSetUp(section), "PetscSectionSetUp");
  check_petsc(VecCreateSeq(PETSC_COMM_SELF, 3 * n_nodes, &coordinates), "VecCreateSeq");
  check_petsc(VecSetBlockSize(coordinates, 3), "VecSetBlockSize");
  check_petsc(VecGetArray(coordinates, &x), "VecGetArray");
  for (PetscInt i = 0; i < n_nodes; ++i)
    for (int axis = 0; axis < 3; ++axis) x[3 * i + axis] = whole.node[i][axis];
  check_petsc(VecRestoreArray(coordinates, &x), "VecRestoreArray");
  check_petsc(DMSetCoordinatesLocal(dm, coordinates), "DMSetCoordinatesLocal");
  VecDestroy(&coordinates);
}

}  // namespace

std::vector<PetscInt> plex_order(const MeshParts& whole) {
  std::vector<PetscInt> order;
  order.reserve(whole.shape.size());
  for (const CellShape shape : shapes_in_order)
    for (std::size_t c = 0; c < whole.shape.size(); ++c)
      if (whole.shape[c] == shape) order.push_back(static_cast<PetscInt>(c));
  return order;
}

DM plex_of(const MeshParts& whole, const std::vector<PetscInt>& order, MPI_Comm comm) {
  DM dm = nullptr;
  check_petsc(DMCreate(comm, &dm), "DMCreate");
  check_petsc(DMSetType(dm, DMPLEX), "DMSetType");
  check_petsc(DMSetDimension(dm, 3), "DMSetDimension");
  add_cells(dm, whole, order);
  add_faces_and_edges(dm);
  add_positions(dm, whole, static_cast<PetscInt>(order.size()));
  on_all_ranks(comm, [&] { add_names(dm, whole, order); });
  return dm;
}

}  // namespace snag
