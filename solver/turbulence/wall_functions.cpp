#include "solver/turbulence/wall_functions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace snag {

namespace {

/// y of a boundary face.
double wall_distance(const Mesh& mesh, int f) { return dot(mesh.delta[f], unit(mesh.face_vector[f])); }

Vec3 part_along(const Vec3& u, const Vec3& n) { return u - dot(u, n) * n; }

}  // namespace

void WallLaw::set_y_laminar() {
  y_laminar = 11;
  for (int i = 0; i < 100; ++i) y_laminar = std::log(E * y_laminar) / kappa;  // contracts by 1/(kappa y) < 1/4 a turn
}

double WallLaw::viscosity_ratio(double y_star) const { return kappa * y_star / std::log(E * std::max(y_star, y_laminar)); }

double WallLaw::distance(double y, double u_star, double nu) const { return std::max(y, y_laminar * nu / u_star); }

double WallLaw::friction_speed(double k) const { return std::sqrt(std::sqrt(C_mu) * k); }

WallFunctions::WallFunctions(const Mesh& mesh, const BoundarySet& boundary, const WallLaw& law) : law_(law) {
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
  production_.resize(cells_.size()), dissipation_.resize(cells_.size());
}

void WallFunctions::set_viscosity(Flow& flow, const std::vector<double>& k) const {
  const double nu = flow.dynamic_viscosity / flow.density;
  for (const WallFace& wall : faces_) {
    const int f = wall.face(flow.mesh);
    const double y_star = law_.friction_speed(k[cells_[wall.wall_cell]]) * wall_distance(flow.mesh, f) / nu;
    flow.y_plus[wall.boundary_face] = y_star;
    flow.face_viscosity[f] = flow.dynamic_viscosity * law_.viscosity_ratio(y_star);
  }
}

void WallFunctions::equilibrium(const Flow& flow, const BoundarySet& boundary, const std::vector<double>& k) {
  const double nu = flow.dynamic_viscosity / flow.density;
  std::fill(production_.begin(), production_.end(), 0.0);
  std::fill(dissipation_.begin(), dissipation_.end(), 0.0);
  for (const WallFace& wall : faces_) {
    const int P = cells_[wall.wall_cell], f = wall.face(flow.mesh);
    const double y = wall_distance(flow.mesh, f), u_star = law_.friction_speed(k[P]), y_star = u_star * y / nu;
    const Vec3 slip = flow.velocity[P] - boundary.values().velocity[wall.boundary_face];
    const double shear = nu * law_.viscosity_ratio(y_star) * norm(part_along(slip, unit(flow.mesh.face_vector[f]))) / y;
    const double length = law_.kappa * law_.distance(y, u_star, nu);
    production_[wall.wall_cell] += wall.share * shear * u_star / length;
    dissipation_[wall.wall_cell] += wall.share * u_star * u_star * u_star / length;
  }
}

void WallFunctions::slip(const Flow& flow, const BoundarySet& boundary, std::vector<Vec3>& velocity) const {
  for (const WallFace& wall : faces_) {
    const int P = cells_[wall.wall_cell], f = wall.face(flow.mesh);
    const Vec3& u_w = boundary.values().velocity[wall.boundary_face];
    const Vec3 along = part_along(flow.velocity[P] - u_w, unit(flow.mesh.face_vector[f]));
    const double drop = flow.face_viscosity[f] / (flow.dynamic_viscosity + flow.density * flow.eddy_viscosity[P]);
    velocity[wall.boundary_face] = u_w + (1 - std::min(drop, 1.0)) * along;
  }
}

}  // namespace snag
