#include "mesh/import/plex.hpp"

#include <algorithm>
#include <array>

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

/// Cells, vertices, faces, numbered in this order; a cell has its faces for a cone, a face its vertices, and there are no edges.
void add_points(DM dm, const MeshParts& whole, const std::vector<LocalFace>& faces, const std::vector<PetscInt>& order) {
  const auto n_cells = static_cast<PetscInt>(order.size()), n_nodes = static_cast<PetscInt>(whole.node.size());
  const auto n_faces = static_cast<PetscInt>(faces.size()), first_face = n_cells + n_nodes;
  check_petsc(DMPlexSetChart(dm, 0, first_face + n_faces), "DMPlexSetChart");
  check_petsc(DMCreateLabel(dm, "celltype"), "DMCreateLabel");  // otherwise DMPlex guesses the types, from cones that are not there yet
  for (PetscInt c = 0; c < n_cells; ++c) {
    const CellShape shape = whole.shape[order[c]];
    check_petsc(DMPlexSetConeSize(dm, c, static_cast<PetscInt>(faces_of(shape).size())), "DMPlexSetConeSize");
    check_petsc(DMPlexSetCellType(dm, c, polytope(shape)), "DMPlexSetCellType");
  }
  for (PetscInt v = n_cells; v < first_face; ++v) check_petsc(DMPlexSetCellType(dm, v, DM_POLYTOPE_POINT), "DMPlexSetCellType");
  for (PetscInt f = 0; f < n_faces; ++f) {
    check_petsc(DMPlexSetConeSize(dm, first_face + f, faces[f].n_nodes), "DMPlexSetConeSize");
    const DMPolytopeType shape = faces[f].n_nodes == 3 ? DM_POLYTOPE_TRIANGLE : DM_POLYTOPE_QUADRILATERAL;
    check_petsc(DMPlexSetCellType(dm, first_face + f, shape), "DMPlexSetCellType");
  }
  check_petsc(DMSetUp(dm), "DMSetUp");

  std::vector<PetscInt> number(order.size());  // in the DMPlex, of a cell of `whole`
  for (PetscInt c = 0; c < n_cells; ++c) number[order[c]] = c;
  std::vector<int> n_found(order.size(), 0);
  for (PetscInt f = 0; f < n_faces; ++f) {
    const LocalFace& face = faces[f];
    for (const int cell : {face.owner, face.neighbour})
      if (cell >= 0) check_petsc(DMPlexInsertCone(dm, number[cell], n_found[cell]++, first_face + f), "DMPlexInsertCone");
    for (int i = 0; i < face.n_nodes; ++i) check_petsc(DMPlexInsertCone(dm, first_face + f, i, n_cells + face.node[i]), "DMPlexInsertCone");
  }
  check_petsc(DMPlexSymmetrize(dm), "DMPlexSymmetrize");
  check_petsc(DMPlexStratify(dm), "DMPlexStratify");
}

void add_names(DM dm, const MeshParts& whole, const std::vector<LocalFace>& faces, const std::vector<PetscInt>& order) {
  for (const char* label : {zone_label, patch_label}) check_petsc(DMCreateLabel(dm, label), "DMCreateLabel");
  const auto n_cells = static_cast<PetscInt>(order.size()), first_face = n_cells + static_cast<PetscInt>(whole.node.size());
  for (PetscInt c = 0; c < n_cells; ++c)
    if (whole.zone[order[c]] >= 0) check_petsc(DMSetLabelValue(dm, zone_label, c, whole.zone[order[c]]), "DMSetLabelValue");
  DMLabel patches = nullptr;
  check_petsc(DMGetLabel(dm, patch_label, &patches), "DMGetLabel");
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (const int patch = std::max(faces[f].patch, faces[f].name_inside); patch >= 0)
      check_petsc(DMLabelSetValue(patches, first_face + static_cast<PetscInt>(f), patch), "DMLabelSetValue");
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

DM plex_of(const MeshParts& whole, const std::vector<LocalFace>& faces, const std::vector<PetscInt>& order, MPI_Comm comm) {
  DM dm = nullptr;
  check_petsc(DMCreate(comm, &dm), "DMCreate");
  check_petsc(DMSetType(dm, DMPLEX), "DMSetType");
  check_petsc(DMSetDimension(dm, 3), "DMSetDimension");
  add_points(dm, whole, faces, order);
  add_positions(dm, whole, static_cast<PetscInt>(order.size()));
  add_names(dm, whole, faces, order);
  return dm;
}

}  // namespace snag
