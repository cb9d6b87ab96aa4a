#include "solver/patch_monitors.hpp"

#include "parallel/sum.hpp"

namespace snag {

double patch_flow_rate(const Flow& flow, std::size_t patch) {
  const Patch& faces = flow.mesh.patches[patch];
  return sum(flow.mesh.comm, std::span<const double>(flow.flux).subspan(faces.first, faces.count));
}

double patch_mean_pressure(const Flow& flow, std::size_t patch) {
  const Mesh& mesh = flow.mesh;
  const Patch& faces = mesh.patches[patch];
  std::vector<double> force, area;
  for (int f = faces.first; f < faces.end(); ++f) {
    area.push_back(norm(mesh.face_vector[f]));
    force.push_back(area.back() * flow.boundary_pressure[f - mesh.n_interior]);
  }
  const double total = sum(mesh.comm, area);
  return total > 0 ? sum(mesh.comm, force) / total : 0;
}

}  // namespace snag
