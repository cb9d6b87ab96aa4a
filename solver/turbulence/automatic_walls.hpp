#pragma once
// Automatic wall treatment for models of omega: one law of the wall from the viscous layer to the log layer, so that the centre of the
// cell at a wall, at the distance y, may lie in any of them (y+ below 1 to some hundreds).
//
//   y+ = u+ + (1/E) (e^s - 1 - s - s^2/2 - s^3/6),   s = kappa u+           Spalding, J. Appl. Mech. 28 (1961) 455
//   u+ = |(u_P - u_w)_t| / u_tau,   y+ = u_tau y/nu  ->  u_tau;       tau_w = rho u_tau^2
//   omega_P^2 = omega_vis^2 + omega_log^2,   omega_vis = 6 nu/(beta_1 y^2),   omega_log = u_tau/(beta*^(1/2) kappa y)
//
// The blend of omega: Menter, Kuntz, Langtry (2003), section "near wall treatment"; their u_tau is a blend of the two layers, (u_vis^4 +
// u_log^4)^(1/4), which is 3 % above that of Spalding's curve at y+ 9.
//
// A cell with several wall faces has one u_tau, the mean of those of its faces, weighted with their areas.
#include "solver/turbulence/wall_faces.hpp"

namespace snag {

struct SpaldingLaw {
  double kappa = 0.41, E = 9.8;

  /// y+ of u+, and its slope d y+/d u+.
  double y_plus(double u_plus) const;
  double slope(double u_plus) const;
  /// u+ of y+; and of the product u+ y+ = u y/nu, which is known before u_tau is.
  double u_plus(double y_plus) const;
  double u_plus_of_product(double product) const;
};

class AutomaticWalls : public WallFaces {
 public:
  AutomaticWalls() = default;
  /// Local.
  AutomaticWalls(const Mesh& mesh, const BoundarySet& boundary, const SpaldingLaw& law) : WallFaces(mesh, boundary), law_(law) {}

  /// u_tau, m/s, of the wall cells from the velocity of the flow; other cells of `friction_velocity` [n_all_cells] stay. Local.
  void find(const Flow& flow, const BoundarySet& boundary, std::vector<double>& friction_velocity) const;
  /// Sets mu_w, of tau_w = mu_w (u_P - u_w)_t / y, in flow.face_viscosity, and flow.y_plus. Local.
  void set_viscosity(Flow& flow, const std::vector<double>& friction_velocity) const;
  /// omega_P, 1/s, of the wall cells; [cells().size()]. Local.
  std::vector<double> omega(const Flow& flow, const std::vector<double>& friction_velocity, double beta_star, double beta_1) const;

 private:
  SpaldingLaw law_;
};

}  // namespace snag
