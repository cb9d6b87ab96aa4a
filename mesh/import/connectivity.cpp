// Two cells share a face when it has the same nodes. All faces of all cells are put in buckets by their lowest node and sorted there: O(n)
// for bounded valence.
#include "mesh/import/connectivity.hpp"

#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "base/room.hpp"
#include "base/words.hpp"
#include "mesh/geometry.hpp"
#include "mesh/shapes.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr int none = std::numeric_limits<int>::max();  // fourth node of a triangle: sorts behind all nodes

/// One side of a face, as a cell or as the list of named boundary faces knows it.
struct Side {
  std::array<int, 4> key;  // nodes in rising order
  int cell;                // -1: a named boundary face
  int index;               // face of the cell's shape; patch of a named face
};

std::array<int, 4> key_of(std::span<const int> nodes) {
  std::array<int, 4> key{none, none, none, none};
  std::copy(nodes.begin(), nodes.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<Side> sides_of(const MeshParts& parts) {
  std::vector<Side> sides;
  sides.reserve(4 * parts.shape.size() + parts.boundary_patch.size());
  for (int c = 0; c < static_cast<int>(parts.shape.size()); ++c) {
    const auto nodes = row(parts.cell_start, parts.cell_node, c);
    int index = 0;
    for (const ShapeFace& face : faces_of(parts.shape[c])) {
      std::array<int, 4> node{};
      for (int i = 0; i < face.n_nodes; ++i) node[i] = nodes[face.node[i]];
      sides.push_back({key_of({node.data(), static_cast<std::size_t>(face.n_nodes)}), c, index++});
    }
  }
  for (int b = 0; b < static_cast<int>(parts.boundary_patch.size()); ++b)
    sides.push_back({key_of(row(parts.boundary_start, parts.boundary_node, b)), -1, parts.boundary_patch[b]});
  return sides;
}

/// Sides grouped by face: by the lowest node (counting sort), then by the rest of the key and the cell.
std::vector<Side> grouped(const std::vector<Side>& sides, std::size_t n_nodes) {
  std::vector<int> start(n_nodes + 1, 0);
  for (const Side& side : sides) ++start[side.key[0] + 1];
  for (std::size_t i = 0; i < n_nodes; ++i) start[i + 1] += start[i];
  std::vector<Side> result(sides.size());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (const Side& side : sides) result[next[side.key[0]]++] = side;
  for (std::size_t i = 0; i < n_nodes; ++i)
    std::sort(result.begin() + start[i], result.begin() + start[i + 1], [](const Side& a, const Side& b) {
      return a.key != b.key ? a.key < b.key : a.cell != b.cell ? a.cell < b.cell : a.index < b.index;
    });
  return result;
}

/// Sides of the same face together.
template <class Act>
void for_each_group(const std::vector<Side>& sides, const Act& act) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].key == sides[begin].key) ++end;
    act(std::span(sides).subspan(begin, end - begin));
  }
}

/// Nodes of a face of a cell, out of the cell, from the node of lowest node_id.
void take_nodes(const MeshParts& parts, int cell, int index, LocalFace& face) {
  const auto nodes = row(parts.cell_start, parts.cell_node, cell);
  const ShapeFace& shape = faces_of(parts.shape[cell])[index];
  face.n_nodes = shape.n_nodes;
  std::array<int, 4> node{};
  for (int i = 0; i < shape.n_nodes; ++i) node[i] = nodes[shape.node[i]];
  const auto end = node.begin() + shape.n_nodes;
  std::rotate(node.begin(), std::min_element(node.begin(), end, [&](int a, int b) { return parts.node_id[a] < parts.node_id[b]; }), end);
  std::copy(node.begin(), end, face.node.begin());
}

Vec3 middle(const MeshParts& parts, const std::array<int, 4>& key) {
  Vec3 total;
  const int n = key[3] == none ? 3 : 4;
  for (int i = 0; i < n; ++i) total += parts.node[key[i]];
  return total / n;
}

[[noreturn]] void throw_overlap(const MeshParts& parts, const Side& side, std::ptrdiff_t n_cells) {
  throw Error(ExitCode::mesh, parts.source + ": a face at " + point_text(middle(parts, side.key)) + " belongs to " +
                                  std::to_string(n_cells) +
                                  " cells, at most two may share it; mesh the volumes without overlap and without duplicate cells");
}

/// The face of one group of sides: cells in rising order behind the named faces. Owner -1 if no owned cell has it.
LocalFace face_of(const MeshParts& parts, std::span<const Side> group) {
  const auto first_cell = std::find_if(group.begin(), group.end(), [](const Side& side) { return side.cell >= 0; });
  const auto n_cells = group.end() - first_cell;
  LocalFace face;
  if (n_cells == 0 || first_cell->cell >= parts.n_owned) return face;  // of ghosts only, or a name without a cell here
  if (n_cells > 2) throw_overlap(parts, group[0], n_cells);
  Side owner = *first_cell;
  if (n_cells == 2) {
    Side neighbour = first_cell[1];
    if (parts.cell_id[neighbour.cell] < parts.cell_id[owner.cell]) std::swap(owner, neighbour);
    face.neighbour = neighbour.cell;
    if (first_cell != group.begin()) face.name_inside = group.front().index;
  } else if (first_cell != group.begin()) {
    face.patch = group.front().index;
    if (first_cell[-1].index != face.patch)
      throw Error(ExitCode::mesh, parts.source + ": the boundary face at " + point_text(middle(parts, group[0].key)) +
                                      " has two names, \"" + parts.patches[face.patch] + "\" and \"" + parts.patches[first_cell[-1].index] +
                                      "\"; give every surface one physical name");
  }
  face.owner = owner.cell;
  take_nodes(parts, owner.cell, owner.index, face);
  return face;
}

void require_distinct_nodes(const MeshParts& parts) {
  for (int c = 0; c < static_cast<int>(parts.shape.size()); ++c) {
    const auto nodes = row(parts.cell_start, parts.cell_node, c);
    std::vector<int> sorted(nodes.begin(), nodes.end());
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice == sorted.end()) continue;
    throw Error(ExitCode::mesh, parts.source + ": cell " + std::to_string(c + 1) + " of the file has the node at " +
                                    point_text(parts.node[*twice]) + " twice, all corners of a cell must differ; mesh that volume again");
  }
}

/// The node opposite to the first of the key: two quadrilaterals of the same nodes have the same cycle, either way round, if it agrees.
int opposite_node(const MeshParts& parts, const Side& side) {
  LocalFace face;
  take_nodes(parts, side.cell, side.index, face);
  const auto at = std::find(face.node.begin(), face.node.end(), side.key[0]) - face.node.begin();
  return face.node[(at + 2) % 4];
}

void require_fitting_sides(const MeshParts& parts, std::span<const Side> group) {
  const auto first_cell = std::find_if(group.begin(), group.end(), [](const Side& side) { return side.cell >= 0; });
  const auto n_cells = group.end() - first_cell;
  const Side& side = group[0];
  if (n_cells == 0)
    throw Error(ExitCode::mesh,
                parts.source + ": a face of the surface \"" + parts.patches[side.index] + "\" at " + point_text(middle(parts, side.key)) +
                    " is not a face of a cell, it must be one; a cell is missing there or has its corners in a wrong order: mesh "
                    "surfaces and volumes together");
  if (n_cells > 2) throw_overlap(parts, side, n_cells);
  if (n_cells == 2 && side.key[3] != none && opposite_node(parts, first_cell[0]) != opposite_node(parts, first_cell[1]))
    throw Error(ExitCode::mesh,
                parts.source + ": the face between cells " + std::to_string(first_cell[0].cell + 1) + " and " +
                    std::to_string(first_cell[1].cell + 1) + " of the file at " + point_text(middle(parts, side.key)) +
                    " has its corners in another cycle in each; one of the cells is twisted: write its corners in gmsh's order");
}

void require_names(const MeshParts& parts, const std::vector<LocalFace>& faces) {
  std::size_t n_unnamed = 0;
  const LocalFace* first = nullptr;
  for (const LocalFace& face : faces)
    if (face.neighbour < 0 && face.patch < 0 && n_unnamed++ == 0) first = &face;
  if (n_unnamed == 0) return;
  Vec3 where;
  for (int i = 0; i < first->n_nodes; ++i) where += parts.node[first->node[i]];
  throw Error(ExitCode::mesh,
              parts.source + ": " + std::to_string(n_unnamed) + " or more faces of the boundary have no name, the first at " +
                  point_text(where / first->n_nodes) +
                  "; every surface of the boundary needs a name (gmsh: Physical Surface(\"wall\") = {...}). If the place lies "
                  "inside the water, two volumes meet there without common nodes: merge them (gmsh: Coherence Mesh)");
}

}  // namespace

std::vector<LocalFace> fitting_faces(const MeshParts& parts) {
  require_distinct_nodes(parts);
  const auto sides = grouped(sides_of(parts), parts.node.size());
  std::vector<LocalFace> faces;
  faces.reserve(sides.size() / 2);
  for_each_group(sides, [&](std::span<const Side> group) {
    require_fitting_sides(parts, group);
    faces.push_back(face_of(parts, group));
  });
  return faces;
}

std::vector<LocalFace> connect(const MeshParts& parts) {
  std::vector<LocalFace> faces;
  on_all_ranks(parts.comm, [&] {
    const auto sides = grouped(sides_of(parts), parts.node.size());
    faces.reserve(sides.size() / 2);
    for_each_group(sides, [&](std::span<const Side> group) {
      const LocalFace face = face_of(parts, group);
      if (face.owner >= 0) faces.push_back(face);
    });
    require_names(parts, faces);
  });
  return faces;
}

void list_cell_faces(Mesh& mesh) {
  mesh.cell_face_start.assign(static_cast<std::size_t>(mesh.n_cells) + 1, 0);
  const auto for_each_side = [&](const auto& act) {
    for (int f = 0; f < mesh.n_faces; ++f) {
      if (mesh.owner[f] < mesh.n_cells) act(mesh.owner[f], f);
      if (mesh.neighbour[f] >= 0 && mesh.neighbour[f] < mesh.n_cells) act(mesh.neighbour[f], f);
    }
  };
  for_each_side([&](int cell, int) { ++mesh.cell_face_start[cell + 1]; });
  for (int c = 0; c < mesh.n_cells; ++c) mesh.cell_face_start[c + 1] += mesh.cell_face_start[c];
  resize_with_room(mesh.cell_face, static_cast<std::size_t>(mesh.cell_face_start[mesh.n_cells]));
  std::vector<int> next(mesh.cell_face_start.begin(), mesh.cell_face_start.end() - 1);
  for_each_side([&](int cell, int face) { mesh.cell_face[next[cell]++] = face; });
}

}  // namespace snag
