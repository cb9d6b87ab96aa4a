#include "mesh/skewness.hpp"

#include <algorithm>

namespace snag {

double skew_share(const Mesh& mesh, int f) {
  const Vec3 s = skewness(mesh, f);
  double most = 0;  // |s| e
  for (int k = mesh.face_node_start[f]; k < mesh.face_node_start[f + 1]; ++k)
    most = std::max(most, std::abs(dot(mesh.node[mesh.face_node[k]] - mesh.face_centre[f], s)));
  return most > 0 ? std::clamp(2 - norm_squared(s) / most, 0.0, 1.0) : 1;
}

std::vector<int> skew_faces(const Mesh& mesh) {
  std::vector<int> faces;
  for (int f = 0; f < mesh.first_facet; ++f)
    if (is_skew(mesh, f, skewness(mesh, f))) faces.push_back(f);
  return faces;
}

std::vector<int> skew_cells(const Mesh& mesh) {
  std::vector<int> cells;
  for (const int f : skew_faces(mesh))
    for (const int c : {mesh.owner[f], mesh.neighbour[f]})
      if (c < mesh.n_cells) cells.push_back(c);
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::vector<int> corner_cells(const Mesh& mesh) {
  std::vector<int> cells;
  for (int c = 0; c < mesh.n_cells; ++c) {
    int n_boundary = 0, n_interior = 0;
    bool slides = false;
    for (int k = mesh.cell_face_start[c]; k < mesh.cell_face_start[c + 1]; ++k) {
      const int f = mesh.cell_face[k];
      if (f >= mesh.n_interior)
        ++n_boundary;
      else if (f >= mesh.first_facet)
        slides = true;
      else
        ++n_interior;
    }
    if (n_boundary >= 2 && n_interior + slides <= 2) cells.push_back(c);
  }
  return cells;
}

}  // namespace snag
