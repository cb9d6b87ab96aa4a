#include "solver/turbulence/wall_functions.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

void WallLaw::set_y_laminar() {
  y_laminar = 11;
  for (int i = 0; i < 100; ++i) y_laminar = std::log(E * y_laminar) / kappa;  // contracts by 1/(kappa y) < 1/4 a turn
}

double WallLaw::viscosity_ratio(double y_star) const { return kappa * y_star / std::log(E * std::max(y_star, y_laminar)); }

double WallLaw::distance(double y, double u_star, double nu) const { return std::max(y, y_laminar * nu / u_star); }

double WallLaw::friction_speed(double k) const { return std::sqrt(std::sqrt(C_mu) * k); }

WallFunctions::WallFunctions(const Mesh& mesh, const BoundarySet& boundary, const WallLaw& law) : WallFaces(mesh, boundary), law_(law) {
  production_.resize(cells_.size()), dissipation_.resize(cells_.size());
}

void WallFunctions::set_viscosity(Flow& flow, const std::vector<double>& k) const {
  const double nu = flow.dynamic_viscosity / flow.density;
  for (const WallFace& wall : faces_) {
    const int f = wall.face(flow.mesh);
    const double y_star = law_.friction_speed(k[cells_[wall.wall_cell]]) * wall.distance(flow.mesh) / nu;
    flow.y_plus[wall.boundary_face] = y_star;
    flow.face_viscosity[f] = flow.dynamic_viscosity * law_.viscosity_ratio(y_star);
  }
}

void WallFunctions::equilibrium(const Flow& flow, const BoundarySet& boundary, const std::vector<double>& k) {
  const double nu = flow.dynamic_viscosity / flow.density;
  std::fill(production_.begin(), production_.end(), 0.0);
  std::fill(dissipation_.begin(), dissipation_.end(), 0.0);
  for (const WallFace& wall : faces_) {
    const double y = wall.distance(flow.mesh), u_star = law_.friction_speed(k[cells_[wall.wall_cell]]), y_star = u_star * y / nu;
    const double shear = nu * law_.viscosity_ratio(y_star) * norm(velocity_along(flow, boundary, wall)) / y;
    const double length = law_.kappa * law_.distance(y, u_star, nu);
    production_[wall.wall_cell] += wall.share * shear * u_star / length;
    dissipation_[wall.wall_cell] += wall.share * u_star * u_star * u_star / length;
  }
}

}  // namespace snag
