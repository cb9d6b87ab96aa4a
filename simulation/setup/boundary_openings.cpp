#include "simulation/setup/boundary_openings.hpp"

#include <algorithm>

#include "mesh/geometry.hpp"
#include "parallel/sum.hpp"

namespace snag {

std::vector<Opening> openings(const Mesh& mesh, const BoundarySet& boundary) {
  std::vector<Opening> found;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    const Patch& patch = mesh.patches[p];
    const bool leads_out = boundary.leads_out(static_cast<int>(p));
    if (boundary.pressure_side(static_cast<int>(p)) != Side::value && !leads_out) continue;
    std::vector<Vec3> vectors, moments;
    std::vector<double> areas;
    for (int f = patch.first; f < patch.end(); ++f) {
      const double area = norm(mesh.face_vector[f]);
      vectors.push_back(mesh.face_vector[f]), moments.push_back(area * mesh.face_centre[f]), areas.push_back(area);
    }
    Opening opening{patch.name, sum(mesh.comm, moments) / sum(mesh.comm, areas), unit(sum(mesh.comm, vectors)), 0, leads_out};
    double radius = 0;
    for (int f = patch.first; f < patch.end(); ++f)
      for (const int node : row(mesh.face_node_start, mesh.face_node, f)) radius = std::max(radius, norm(mesh.node[node] - opening.centre));
    opening.radius = maximum(mesh.comm, radius);
    found.push_back(opening);
  }
  return found;
}

}  // namespace snag
