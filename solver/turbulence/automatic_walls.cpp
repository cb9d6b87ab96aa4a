#include "solver/turbulence/automatic_walls.hpp"

#include <algorithm>
#include <cmath>

namespace snag {

namespace {

/// Root of a convex, growing function right of which `from` lies: Newton's steps fall towards it and never pass it.
template <class Function>
double root(double from, const Function& value_and_slope) {
  constexpr int most_steps = 60;
  for (int i = 0; i < most_steps; ++i) {
    const auto [value, slope] = value_and_slope(from);
    const double next = from - value / slope;
    if (!(next < from * (1 - 1e-14))) break;
    from = next;
  }
  return from;
}

}  // namespace

double SpaldingLaw::y_plus(double u_plus) const {
  const double s = kappa * u_plus;
  // the series of e^s from its fourth term on: the difference in the law loses all digits at small s
  const double rest = s < 0.5 ? s * s * s * s / 24 * (1 + s / 5 * (1 + s / 6 * (1 + s / 7 * (1 + s / 8 * (1 + s / 9 * (1 + s / 10))))))
                              : std::exp(s) - 1 - s - s * s / 2 - s * s * s / 6;
  return u_plus + rest / E;
}

double SpaldingLaw::slope(double u_plus) const {
  const double s = kappa * u_plus;
  return 1 + kappa / E * (std::exp(s) - 1 - s - s * s / 2);
}

double SpaldingLaw::u_plus(double y_plus_of_it) const {
  const double bound = std::min(y_plus_of_it, std::log(1 + E * y_plus_of_it) / kappa + 8);
  return root(bound, [&](double u) { return std::pair{y_plus(u) - y_plus_of_it, slope(u)}; });
}

double SpaldingLaw::u_plus_of_product(double product) const {
  const double bound = std::min(std::sqrt(product), std::log(1 + E * product) / kappa + 8);
  return root(bound, [&](double u) { return std::pair{u * y_plus(u) - product, y_plus(u) + u * slope(u)}; });
}

void AutomaticWalls::find(const Flow& flow, const BoundarySet& boundary, std::vector<double>& friction_velocity) const {
  const double nu = flow.dynamic_viscosity / flow.density;
  for (const int c : cells_) friction_velocity[c] = 0;
  for (const WallFace& wall : faces_) {
    const double u = norm(velocity_along(flow, boundary, wall)), product = u * wall.distance(flow.mesh) / nu;
    if (product > 0) friction_velocity[cells_[wall.wall_cell]] += wall.share * u / law_.u_plus_of_product(product);
  }
}

void AutomaticWalls::set_viscosity(Flow& flow, const std::vector<double>& friction_velocity) const {
  const double nu = flow.dynamic_viscosity / flow.density;
  for (const WallFace& wall : faces_) {
    const double y_plus = friction_velocity[cells_[wall.wall_cell]] * wall.distance(flow.mesh) / nu;
    flow.y_plus[wall.boundary_face] = y_plus;
    flow.face_viscosity[wall.face(flow.mesh)] = flow.dynamic_viscosity * (y_plus > 0 ? y_plus / law_.u_plus(y_plus) : 1);
  }
}

std::vector<double> AutomaticWalls::omega(const Flow& flow, const std::vector<double>& friction_velocity, double beta_star,
                                          double beta_1) const {
  const double nu = flow.dynamic_viscosity / flow.density;
  std::vector<double> omega(cells_.size());
  for (const WallFace& wall : faces_) {
    const double y = wall.distance(flow.mesh);
    const double in_log_layer = friction_velocity[cells_[wall.wall_cell]] / (std::sqrt(beta_star) * law_.kappa * y);
    omega[wall.wall_cell] += wall.share * std::hypot(6 * nu / (beta_1 * y * y), in_log_layer);
  }
  return omega;
}

}  // namespace snag
