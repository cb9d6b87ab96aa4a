#pragma once
// What a Mesh is built from, whatever the source (a file, a box): cells as lists of nodes, and the named faces of the boundary.
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace snag {

/// The part of one rank: its own cells and, behind them, copies (ghosts) of all cells of other ranks that share a face with them.
struct MeshParts {
  MPI_Comm comm = MPI_COMM_SELF;
  std::string source;                 // for messages: the file, or what made the mesh
  std::vector<Vec3> node;             // m
  std::vector<std::int64_t> node_id;  // number in the source

  // cells: owned, then ghosts, in any order
  int n_owned = 0;
  std::vector<CellShape> shape;
  std::vector<int> cell_start{0}, cell_node;  // compressed rows, VTK order
  std::vector<std::int64_t> cell_id;          // number in the source
  std::vector<int> zone;
  std::vector<int> ghost_rank, ghost_index;  // of ghost g: the rank that owns it and its position there in this order

  // faces of the boundary that have a name (of owned cells at least), 3 or 4 nodes in any order
  std::vector<int> boundary_start{0}, boundary_node, boundary_patch;

  std::vector<std::string> zones, patches;  // the same on every rank
  std::vector<PeriodicPair> periodic;
};

/// Faces, geometry, bandwidth-reducing order, periodic joins, halo. Collective.
/// Throws Error(mesh) for unnamed boundary faces, a face of more than two cells, and unmatched periodic faces.
Mesh build_mesh(MeshParts parts);

/// Add a cell at the end of `parts`.
inline void add_cell(MeshParts& parts, CellShape shape, const int* nodes, int n_nodes) {
  parts.shape.push_back(shape);
  parts.cell_node.insert(parts.cell_node.end(), nodes, nodes + n_nodes);
  parts.cell_start.push_back(static_cast<int>(parts.cell_node.size()));
}

/// Add a named face of the boundary at the end of `parts`.
inline void add_boundary_face(MeshParts& parts, int patch, const int* nodes, int n_nodes) {
  parts.boundary_patch.push_back(patch);
  parts.boundary_node.insert(parts.boundary_node.end(), nodes, nodes + n_nodes);
  parts.boundary_start.push_back(static_cast<int>(parts.boundary_node.size()));
}

}  // namespace snag
