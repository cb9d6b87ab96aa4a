#include "solver/turbulence/wall_functions.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

namespace {
constexpr double fully_rough = 8.5;  // u+ at y = k_s, Nikuradse (1933)
}

void WallLaw::set_y_laminar() {
  y_laminar = 11;
  for (int i = 0; i < 100; ++i) y_laminar = std::log(E * y_laminar) / kappa;  // contracts by 1/(kappa y) < 1/4 a turn
}

double WallLaw::viscosity_ratio(double y_star, double roughness_star) const {
  const double a = E * std::exp(-fully_rough * kappa);
  return kappa * y_star / std::log(E / (1 + a * roughness_star) * std::max({y_star, y_laminar, 0.5 * roughness_star}));
}

double WallLaw::distance(double y, double u_star, double nu, double roughness) const {
  return std::max({y, y_laminar * nu / u_star, 0.5 * roughness});
}

double WallLaw::friction_speed(double k) const { return std::sqrt(std::sqrt(C_mu) * k); }

WallFunctions::WallFunctions(const Mesh& mesh, const BoundarySet& boundary, const WallLaw& law) : WallFaces(mesh, boundary), law_(law) {
  production_.resize(cells_.size()), dissipation_.resize(cells_.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)  // in the order of faces_
    if (boundary.is_wall(static_cast<int>(p)))
      roughness_.insert(roughness_.end(), static_cast<std::size_t>(mesh.patches[p].count), boundary.roughness(static_cast<int>(p)));
}

void WallFunctions::set_viscosity(Flow& flow, const std::vector<double>& k) const {
  const double nu = flow.dynamic_viscosity / flow.density;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const WallFace& wall = faces_[i];
    const double u_star = law_.friction_speed(k[cells_[wall.wall_cell]]), y_star = u_star * wall.distance(flow.mesh) / nu;
    flow.y_plus[wall.boundary_face] = y_star;
    flow.face_viscosity[wall.face(flow.mesh)] = flow.dynamic_viscosity * law_.viscosity_ratio(y_star, u_star * roughness_[i] / nu);
  }
}

void WallFunctions::equilibrium(const Flow& flow, const BoundarySet& boundary, const std::vector<double>& k) {
  const double nu = flow.dynamic_viscosity / flow.density;
  std::fill(production_.begin(), production_.end(), 0.0);
  std::fill(dissipation_.begin(), dissipation_.end(), 0.0);
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const WallFace& wall = faces_[i];
    const double y = wall.distance(flow.mesh), u_star = law_.friction_speed(k[cells_[wall.wall_cell]]), y_star = u_star * y / nu;
    const double shear = nu * law_.viscosity_ratio(y_star, u_star * roughness_[i] / nu) * norm(velocity_along(flow, boundary, wall)) / y;
    const double length = law_.kappa * law_.distance(y, u_star, nu, roughness_[i]);
    production_[wall.wall_cell] += wall.share * shear * u_star / length;
    dissipation_[wall.wall_cell] += wall.share * u_star * u_star * u_star / length;
  }
}

}  // namespace snag
