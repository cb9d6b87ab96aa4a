#include "mesh/skewness.hpp"

#include <algorithm>

namespace snag {

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

}  // namespace snag
