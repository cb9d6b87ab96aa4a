#pragma once
// Faces between cells, found from the cells' nodes.
#include <array>

#include "mesh/import/parts.hpp"

namespace snag {

/// A face of this rank before it is ordered.
struct LocalFace {
  int owner = -1, neighbour = -1;  // cells of MeshParts; neighbour -1 on the boundary; the owner has the lower cell_id
  int patch = -1;                  // of a boundary face
  int name_inside = -1;            // patch whose name an interior face has
  int n_nodes = 0;
  std::array<int, 4> node{-1, -1, -1,
                          -1};  // out of the owner, from the node of lowest node_id: so the same on both ranks that hold the face
  Vec3 shift;                   // to add to the neighbour's centre: not zero across a period
};

/// Faces of one whole mesh whose cells fit together: eight (six, five, four) nodes each, a face that two cells share has its corners in the
/// same cycle in both, and every named face is one of a cell. Not collective; throws Error(mesh) with the place.
std::vector<LocalFace> fitting_faces(const MeshParts& parts);

/// All faces with at least one owned cell. Collective; throws Error(mesh) for a face of more than two cells or of the boundary without a
/// name.
std::vector<LocalFace> connect(const MeshParts& parts);

/// Joins the faces of periodic patches to interior faces; cells of other ranks across a period become ghosts at the end of `parts`.
/// Collective; throws Error(mesh) for a face without partner or an unknown patch.
void join_periodic(MeshParts& parts, std::vector<LocalFace>& faces);

/// Fills cell_face_start and cell_face from owner and neighbour: rows of rising face numbers. A cell one period wide is its own neighbour
/// and lists that face twice.
void list_cell_faces(Mesh& mesh);

}  // namespace snag
