#pragma once
// A plane mesh of gmsh swept along z: triangles become prisms, quadrangles hexahedra. Parts of the plane may be swept through some of the
// levels only, and cells of other origin may be joined to the nodes.
#include <map>
#include <string>
#include <vector>

#include "mesh/generate/cells.hpp"

namespace snag::generate {

using EdgeNodes = std::array<Node, 2>;

/// Triangles and quadrangles on plane surfaces of the current model, counter-clockwise.
std::vector<FaceNodes> plane_faces(const std::vector<int>& surfaces);
/// Edges on curves of the current model, in the direction of the curves.
std::vector<EdgeNodes> plane_edges(const std::vector<int>& curves);

struct LevelRange {
  int from, to;
};

class SweptMesh {
 public:
  /// All nodes of the current model may be swept through these levels. z in m, ascending.
  explicit SweptMesh(std::vector<double> levels);

  void sweep(const std::string& volume, const std::vector<FaceNodes>& faces, LevelRange range);
  void add_plane(const std::string& patch, const std::vector<FaceNodes>& faces, int level);
  void add_sides(const std::string& patch, const std::vector<EdgeNodes>& edges, LevelRange range);

  Vec3 position_in_plane(Node node) const { return plane_[node]; }
  /// The node above a node of the plane; it is made when it is first asked for.
  Node node(Node plane_node, int level);
  Node add_node(const Vec3& position);
  /// Hexahedra of 8 nodes, prisms of 6, in the order of gmsh.
  void add_cell(const std::string& volume, const std::vector<Node>& nodes);
  void add_face(const std::string& patch, const FaceNodes& face);

  /// A model with these cells, volumes and patches instead of the current one.
  void replace_current_model() const;

 private:
  using Elements = std::map<std::size_t, std::vector<std::size_t>>;  // nodes of all elements, by the number of nodes of one
  std::vector<double> levels_;                                       // m
  std::vector<Vec3> plane_;                                          // m, by node of the plane
  std::vector<Node> above_;                                          // [node of the plane][level], 0: not made yet
  std::vector<double> coordinates_;                                  // m, of the nodes 1, 2, ...
  std::map<std::string, Elements> cells_, faces_;
};

}  // namespace snag::generate
