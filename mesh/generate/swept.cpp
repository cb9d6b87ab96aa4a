#include "mesh/generate/swept.hpp"

#include <gmsh.h>

#include <algorithm>
#include <numeric>

#include "mesh/generate/cad.hpp"

namespace snag::generate {

namespace {

constexpr int edge_type = 1, triangle_type = 2, quadrangle_type = 3, hexahedron_type = 5, prism_type = 6;  // of gmsh

double signed_area(const FaceNodes& face, const std::vector<Vec3>& position) {
  double twice = 0;
  const std::size_t n = face[3] ? 4 : 3;
  for (std::size_t k = 0; k < n; ++k) twice += cross(position[face[k]], position[face[(k + 1) % n]]).z;
  return twice / 2;
}

std::vector<Vec3> current_positions() {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  std::vector<Vec3> position(tags.empty() ? 0 : *std::ranges::max_element(tags) + 1);
  for (std::size_t i = 0; i < tags.size(); ++i) position[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
  return position;
}

// Nodes of all elements of one type on an entity, one element after the other.
std::vector<std::size_t> nodes_of(int type, int entity) {
  std::vector<std::size_t> elements, nodes;
  gmsh::model::mesh::getElementsByType(type, elements, nodes, entity);
  return nodes;
}

}  // namespace

std::vector<FaceNodes> plane_faces(const std::vector<int>& surfaces) {
  const auto position = current_positions();
  std::vector<FaceNodes> faces;
  for (const int surface : surfaces)
    for (const auto& [type, n] : {std::pair<int, std::size_t>{triangle_type, 3}, {quadrangle_type, 4}}) {
      const auto nodes = nodes_of(type, surface);
      for (std::size_t first = 0; first < nodes.size(); first += n) {
        FaceNodes face{};
        for (std::size_t k = 0; k < n; ++k) face[k] = static_cast<Node>(nodes[first + k]);
        if (signed_area(face, position) < 0) std::reverse(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(n));
        faces.push_back(face);
      }
    }
  return faces;
}

std::vector<EdgeNodes> plane_edges(const std::vector<int>& curves) {
  std::vector<EdgeNodes> edges;
  for (const int curve : curves) {
    const auto nodes = nodes_of(edge_type, curve);
    for (std::size_t k = 0; k < nodes.size(); k += 2) edges.push_back({static_cast<Node>(nodes[k]), static_cast<Node>(nodes[k + 1])});
  }
  return edges;
}

SweptMesh::SweptMesh(std::vector<double> levels)
    : levels_(std::move(levels)), plane_(current_positions()), above_(plane_.size() * levels_.size()) {}

Node SweptMesh::node(Node plane_node, int level) {
  const auto k = static_cast<std::size_t>(level);
  Node& above = above_[plane_node * levels_.size() + k];
  if (above == 0) above = add_node({plane_[plane_node].x, plane_[plane_node].y, levels_[k]});
  return above;
}

Node SweptMesh::add_node(const Vec3& position) {
  coordinates_.insert(coordinates_.end(), {position.x, position.y, position.z});
  return static_cast<Node>(coordinates_.size() / 3);
}

void SweptMesh::add_cell(const std::string& volume, const std::vector<Node>& nodes) {
  auto& list = cells_[volume][nodes.size()];
  list.insert(list.end(), nodes.begin(), nodes.end());
}

void SweptMesh::add_face(const std::string& patch, const FaceNodes& face) {
  const std::size_t n = face[3] ? 4 : 3;
  auto& list = faces_[patch][n];
  list.insert(list.end(), face.begin(), face.begin() + static_cast<std::ptrdiff_t>(n));
}

void SweptMesh::sweep(const std::string& volume, const std::vector<FaceNodes>& faces, LevelRange range) {
  std::vector<Node> nodes;
  for (const FaceNodes& face : faces)
    for (int level = range.from; level < range.to; ++level) {
      nodes.clear();
      for (const int end : {level, level + 1})
        for (const Node corner : face)
          if (corner != 0) nodes.push_back(node(corner, end));
      add_cell(volume, nodes);
    }
}

void SweptMesh::add_plane(const std::string& patch, const std::vector<FaceNodes>& faces, int level) {
  for (FaceNodes face : faces) {
    for (Node& corner : face)
      if (corner != 0) corner = node(corner, level);
    add_face(patch, face);
  }
}

void SweptMesh::add_sides(const std::string& patch, const std::vector<EdgeNodes>& edges, LevelRange range) {
  for (const auto& [a, b] : edges)
    for (int level = range.from; level < range.to; ++level)
      add_face(patch, {node(a, level), node(b, level), node(b, level + 1), node(a, level + 1)});
}

void SweptMesh::replace_current_model() const {
  gmsh::model::remove();
  gmsh::model::add("snag");
  std::vector<std::size_t> tags(coordinates_.size() / 3);
  std::iota(tags.begin(), tags.end(), std::size_t{1});
  const auto add = [&](int dimension, const std::map<std::string, Elements>& groups, const std::map<std::size_t, int>& type_of) {
    for (int tag = 1; const auto& [name, elements] : groups) {
      gmsh::model::addDiscreteEntity(dimension, tag);
      if (dimension == 3 && tag == 1) gmsh::model::mesh::addNodes(dimension, tag, tags, coordinates_);  // one entity has all nodes
      for (const auto& [n, nodes] : elements) gmsh::model::mesh::addElementsByType(tag, type_of.at(n), {}, nodes);
      name_group(dimension, 10 * (3 - dimension) + tag, name, {tag});
      ++tag;
    }
  };
  add(3, cells_, {{8, hexahedron_type}, {6, prism_type}});
  add(2, faces_, {{4, quadrangle_type}, {3, triangle_type}});
}

}  // namespace snag::generate
