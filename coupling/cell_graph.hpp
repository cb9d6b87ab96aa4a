#pragma once
// Cells as they are joined by faces, beyond the ghosts of a rank: its own cells and all within a margin of them, in the order of cell_id,
// so that what is computed on the graph is the same on any number of ranks. Facets of a sliding interface join as other faces do.
#include <cstdint>
#include <vector>

#include "coupling/cell_weights.hpp"
#include "mesh/mesh.hpp"

namespace snag {

struct CellGraph {
  std::vector<std::int64_t> id;    // cell_id, ascending
  std::vector<Vec3> centre;        // m
  std::vector<double> volume;      // m3
  std::vector<int> own;            // number among the owned cells of this rank, -1: a cell of another rank
  std::vector<char> at_interface;  // has a facet
  // faces of each cell (compressed rows), by the number of the cell beyond in this graph: |S|/|d|, m
  std::vector<int> start, beyond;
  std::vector<double> conductance;

  int size() const { return static_cast<int>(id.size()); }
  /// Number of a cell in this graph, -1: it lies farther away.
  int find(std::int64_t cell_id) const;
  /// From the mesh as it stands; `boxes` around the cells of each rank, `margin` in m. Collective.
  void update(const Mesh& mesh, const RankBoxes& boxes, double margin);
};

}  // namespace snag
