#include "solver/turbulence/wall_faces.hpp"

#include <algorithm>
#include <map>

namespace snag {

WallFaces::WallFaces(const Mesh& mesh, const BoundarySet& boundary) {
  std::map<int, int> place;
  std::vector<double> area;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (!boundary.is_wall(static_cast<int>(p))) continue;
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) {
      const auto [entry, is_first] = place.try_emplace(mesh.owner[f], static_cast<int>(cells_.size()));
      if (is_first) cells_.push_back(mesh.owner[f]), area.push_back(0);
      faces_.push_back({f - mesh.n_interior, entry->second, norm(mesh.face_vector[f])});
      area[entry->second] += faces_.back().share;
    }
  }
  for (WallFace& wall : faces_) wall.share /= area[wall.wall_cell];
}

Vec3 WallFaces::velocity_along(const Flow& flow, const BoundarySet& boundary, const WallFace& wall) const {
  const Vec3 n = unit(flow.mesh.face_vector[wall.face(flow.mesh)]);
  const Vec3 relative = flow.velocity[cells_[wall.wall_cell]] - boundary.values().velocity[wall.boundary_face];
  return relative - dot(relative, n) * n;
}

void WallFaces::slip(const Flow& flow, const BoundarySet& boundary, std::vector<Vec3>& velocity) const {
  for (const WallFace& wall : faces_) {
    const double in_cell = flow.dynamic_viscosity + flow.density * flow.eddy_viscosity[cells_[wall.wall_cell]];
    const double drop = flow.face_viscosity[wall.face(flow.mesh)] / in_cell;
    velocity[wall.boundary_face] =
        boundary.values().velocity[wall.boundary_face] + (1 - std::min(drop, 1.0)) * velocity_along(flow, boundary, wall);
  }
}

}  // namespace snag
