#include "mesh/wall_surface.hpp"

#include <algorithm>
#include <tuple>

#include "mesh/geometry.hpp"
#include "parallel/rows.hpp"

namespace snag {
namespace {

/// A boundary face as it travels between ranks.
struct WallFace {
  std::int64_t cell_id;
  std::array<std::int64_t, 4> node_id;  // from the lowest, right-handed about the way out of the fluid
  std::array<Vec3, 4> node;
  int part, n_nodes, place;
};

WallFace wall_face(const Mesh& mesh, int face, int part) {
  WallFace result{};
  result.cell_id = mesh.cell_id[mesh.owner[face]];
  result.part = part;
  for (const int node : row(mesh.face_node_start, mesh.face_node, face)) {
    result.node[result.n_nodes] = mesh.node[node];
    result.node_id[result.n_nodes++] = mesh.node_id[node];
  }
  return result;
}

}  // namespace

WallSurface wall_surface(const Mesh& mesh, const std::vector<std::string>& patches) {
  std::vector<WallFace> mine;
  for (int part = 0; part < static_cast<int>(patches.size()); ++part) {
    const Patch& patch = mesh.patches[static_cast<std::size_t>(mesh.patch_index(patches[static_cast<std::size_t>(part)]))];
    for (int face = patch.first; face < patch.end(); ++face) mine.push_back(wall_face(mesh, face, part));
  }
  std::vector<WallFace> faces = gathered(mesh.comm, mine);
  for (int i = 0; i < static_cast<int>(faces.size()); ++i) faces[i].place = i;
  std::sort(faces.begin(), faces.end(),
            [](const WallFace& a, const WallFace& b) { return std::tie(a.cell_id, a.node_id) < std::tie(b.cell_id, b.node_id); });

  std::vector<std::int64_t> ids;
  for (const WallFace& face : faces) ids.insert(ids.end(), face.node_id.begin(), face.node_id.begin() + face.n_nodes);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const auto index_of = [&](std::int64_t id) { return static_cast<int>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()); };

  WallSurface surface{patches, {}};
  for (const WallFace& face : faces)
    for (int i = 1; i + 1 < face.n_nodes; ++i) {  // a quadrilateral is cut from its node of lowest number
      WallTriangle triangle;
      triangle.part = face.part, triangle.face = face.place;
      for (std::size_t corner = 0; const int k : {0, i, i + 1}) {
        triangle.node[corner] = face.node[k];
        triangle.node_index[corner++] = index_of(face.node_id[k]);
      }
      triangle.normal = unit(cross(triangle.node[1] - triangle.node[0], triangle.node[2] - triangle.node[0]));
      surface.triangles.push_back(triangle);
    }
  return surface;
}

}  // namespace snag
