#pragma once
// Cells and named faces of the current gmsh mesh as flat lists, and the quality of a cell.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/vec3.hpp"

namespace snag::generate {

/// How the nodes of one kind of cell hang together (order of gmsh).
struct CellKind {
  const char* name;
  int gmsh_type;
  std::size_t n_nodes;
  std::vector<std::array<int, 4>> corners;  // node and its three neighbours, right-handed
  std::vector<std::vector<int>> faces;      // seen from outside counter-clockwise
};
/// Throws Error(mesh) for a kind that no geometry makes.
const CellKind& cell_kind(int gmsh_type);

using Node = std::uint32_t;             // tag of gmsh
using FaceNodes = std::array<Node, 4>;  // triangles have 0 in the last place

/// Sorted nodes: the same for a face seen from both sides.
FaceNodes face_key(const FaceNodes& face);

struct CellFace {
  FaceNodes key, nodes;  // nodes: outward from the cell
  std::uint32_t cell;
};

struct NamedFace {
  FaceNodes key;
  int surface;
};

struct Cells {
  struct Volume {
    std::string name;
    std::vector<const CellKind*> kind;  // of each cell
    std::vector<Node> node;             // of all cells, one after the other
    std::vector<CellFace> boundary;     // faces of one cell only
    int n_components = 0;
    std::int64_t n_crowded_faces = 0;  // faces of three cells or more
  };
  std::vector<Vec3> position;  // m, by tag of the node
  std::vector<bool> exists;    // by tag of the node
  std::vector<Volume> volumes;
  std::vector<std::string> surfaces;
  std::vector<NamedFace> named;

  std::array<Vec3, 4> corners(const FaceNodes& face) const;
};

/// From the current model: everything in named volumes and surfaces.
Cells current_cells();

/// Area vector of a face; a quadrangle counts as four triangles about its mean. m2
Vec3 area_vector(const Cells& cells, const FaceNodes& face);
/// Part of a volume's content that a boundary face carries: 1/3 integral x . dA. m3
double volume_share(const Cells& cells, const FaceNodes& face);

/// Tetrahedra: signed inverse condition number 3/(|A| |A^-1|) sign(det A), A relative to the regular tetrahedron; others: the least
/// scaled Jacobian of the corners (a prism's relative to the regular one). 1 is ideal, 0 flat, negative inverted.
double quality(const CellKind& kind, std::span<const Node> nodes, const Cells& cells);

}  // namespace snag::generate
