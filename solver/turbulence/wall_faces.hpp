#pragma once
// The faces of all walls and the cells at them: what every treatment of walls shares.
//
// A cell with several wall faces takes the mean of what each of them asks for, weighted with the areas of the faces.
#include <vector>

#include "solver/boundaries/boundary.hpp"

namespace snag {

class WallFaces {
 public:
  WallFaces() = default;
  /// Local.
  WallFaces(const Mesh& mesh, const BoundarySet& boundary);

  /// Replaces the velocity at wall faces by that which the gradient in the wall cell leads to: not (u_P - u_w)/y, which is several times as
  /// steep where a wall function acts, but that of the shear in force, tau_w / (mu + mu_t). Local.
  void slip(const Flow& flow, const BoundarySet& boundary, std::vector<Vec3>& velocity) const;
  /// Cells at walls, each once.
  const std::vector<int>& cells() const { return cells_; }

 protected:
  struct WallFace {
    int boundary_face, wall_cell;  // f - n_interior, which stays as a turning mesh changes its facets; place in cells_
    double share;                  // of the area of the cell's wall faces

    int face(const Mesh& mesh) const { return mesh.n_interior + boundary_face; }
    /// y of the cell, m.
    double distance(const Mesh& mesh) const { return dot(mesh.delta[face(mesh)], unit(mesh.face_vector[face(mesh)])); }
  };
  /// (u_P - u_w)_t, m/s.
  Vec3 velocity_along(const Flow& flow, const BoundarySet& boundary, const WallFace& wall) const;

  std::vector<WallFace> faces_;
  std::vector<int> cells_;
};

}  // namespace snag
