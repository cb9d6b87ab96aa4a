#include "mesh/generate/cells.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.hpp"

namespace snag::generate {

namespace {

// Condition number of the map from the regular tetrahedron: A = E W^-1 with the edges of the cell and of the regular one in columns.
double inverse_condition(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double r3 = std::numbers::sqrt3, r6 = std::sqrt(6.0);
  const Vec3 p = a, q = (2 * b - a) / r3, r = (3 * c - a - b) / r6;  // columns of A: W^-1 undoes (1,0,0), (1/2,r3/2,0), (1/2,r3/6,r6/3)
  const double det = dot(p, cross(q, r));
  const double A2 = norm_squared(p) + norm_squared(q) + norm_squared(r);
  const double adjoint2 = norm_squared(cross(q, r)) + norm_squared(cross(r, p)) + norm_squared(cross(p, q));
  return 3 * det / std::sqrt(A2 * adjoint2);
}

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t c) {
  while (parent[c] != c) c = parent[c] = parent[parent[c]];
  return c;
}

// Pairs the faces of cells: what stays alone is boundary, cells joined by faces are one component.
void connect(Cells::Volume& volume) {
  std::vector<CellFace> faces;
  std::size_t first = 0;
  for (std::uint32_t c = 0; c < volume.kind.size(); ++c) {
    for (const auto& face : volume.kind[c]->faces) {
      FaceNodes nodes{};
      for (std::size_t k = 0; k < face.size(); ++k) nodes[k] = volume.node[first + static_cast<std::size_t>(face[k])];
      faces.push_back({face_key(nodes), nodes, c});
    }
    first += volume.kind[c]->n_nodes;
  }
  std::ranges::sort(faces, {}, [](const CellFace& f) { return std::tie(f.key, f.cell); });
  std::vector<std::uint32_t> parent(volume.kind.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    if (end - i == 1) volume.boundary.push_back(faces[i]);
    if (end - i > 2) ++volume.n_crowded_faces;
    for (std::size_t k = i + 1; k < end; ++k) parent[root(parent, faces[k].cell)] = root(parent, faces[i].cell);
    i = end;
  }
  for (std::uint32_t c = 0; c < parent.size(); ++c) volume.n_components += root(parent, c) == c;
}

std::vector<int> entities_of(const std::pair<int, int>& group) {
  std::vector<int> entities;
  gmsh::model::getEntitiesForPhysicalGroup(group.first, group.second, entities);
  return entities;
}

std::string name_of(const std::pair<int, int>& group) {
  std::string name;
  gmsh::model::getPhysicalName(group.first, group.second, name);
  return name;
}

Cells::Volume current_volume(const std::pair<int, int>& group) {
  Cells::Volume volume;
  volume.name = name_of(group);
  for (const int entity : entities_of(group)) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, nodes;
    gmsh::model::mesh::getElements(types, elements, nodes, 3, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      volume.kind.insert(volume.kind.end(), elements[t].size(), &cell_kind(types[t]));
      for (const std::size_t node : nodes[t]) volume.node.push_back(static_cast<Node>(node));
    }
  }
  connect(volume);
  return volume;
}

void add_surface(const std::pair<int, int>& group, Cells& cells) {
  const int surface = static_cast<int>(cells.surfaces.size());
  cells.surfaces.push_back(name_of(group));
  for (const int entity : entities_of(group)) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, nodes;
    gmsh::model::mesh::getElements(types, elements, nodes, 2, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      const std::size_t n = nodes[t].size() / std::max<std::size_t>(1, elements[t].size());
      for (std::size_t e = 0; e < elements[t].size(); ++e) {
        FaceNodes face{};
        for (std::size_t k = 0; k < n; ++k) face[k] = static_cast<Node>(nodes[t][e * n + k]);
        cells.named.push_back({face_key(face), surface});
      }
    }
  }
}

}  // namespace

const CellKind& cell_kind(int gmsh_type) {
  static const std::vector<CellKind> kinds = {
      {"tetrahedra", 4, 4, {{0, 1, 2, 3}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}},
      {"hexahedra",
       5,
       8,
       {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}},
       {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
      {"prisms",
       6,
       6,
       {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}},
       {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}}};
  for (const auto& kind : kinds)
    if (kind.gmsh_type == gmsh_type) return kind;
  throw Error(ExitCode::mesh, "snag-mesh: cells of gmsh type " + std::to_string(gmsh_type) +
                                  " were made, only tetrahedra, hexahedra and prisms are wanted; choose tetrahedra");
}

FaceNodes face_key(const FaceNodes& face) {
  FaceNodes key = face;
  std::ranges::sort(key);
  return key;
}

std::array<Vec3, 4> Cells::corners(const FaceNodes& face) const {
  std::array<Vec3, 4> x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = position[face[k] ? face[k] : face[0]];
  return x;
}

Cells current_cells() {
  Cells cells;
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  const std::size_t n = tags.empty() ? 0 : *std::ranges::max_element(tags) + 1;
  cells.position.resize(n);
  cells.exists.resize(n);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    cells.position[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
    cells.exists[tags[i]] = true;
  }
  std::vector<std::pair<int, int>> groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& group : groups) {
    if (group.first == 3) cells.volumes.push_back(current_volume(group));
    if (group.first == 2) add_surface(group, cells);
  }
  return cells;
}

Vec3 area_vector(const Cells& cells, const FaceNodes& face) {
  const auto x = cells.corners(face);
  return face[3] ? 0.5 * cross(x[2] - x[0], x[3] - x[1]) : 0.5 * cross(x[1] - x[0], x[2] - x[0]);
}

double volume_share(const Cells& cells, const FaceNodes& face) {
  const auto x = cells.corners(face);
  if (!face[3]) return dot(x[0], cross(x[1], x[2])) / 6;
  const Vec3 mean = (x[0] + x[1] + x[2] + x[3]) / 4;
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += dot(mean, cross(x[k], x[(k + 1) % 4])) / 6;
  return sum;
}

double quality(const CellKind& kind, std::span<const Node> nodes, const Cells& cells) {
  const double ideal = kind.n_nodes == 6 ? std::numbers::sqrt3 / 2 : 1;  // determinant of unit edges in the regular cell
  double worst = 1;
  for (const auto& corner : kind.corners) {
    const auto at = [&](std::size_t k) { return cells.position[nodes[static_cast<std::size_t>(corner[k])]]; };
    const Vec3 x = at(0), a = at(1) - x, b = at(2) - x, c = at(3) - x;
    const double q = kind.n_nodes == 4 ? inverse_condition(a, b, c) : dot(a, cross(b, c)) / (ideal * norm(a) * norm(b) * norm(c));
    worst = std::min(worst, std::isfinite(q) ? q : 0.0);
  }
  return worst;
}

}  // namespace snag::generate
