#pragma once
// Scalable wall functions: those of Launder and Spalding (1974), the layer between a wall and the centre of the cell at it, distance y, in
// local equilibrium, at no less than y*_lam, where the log layer meets the viscous one (Grotjans and Menter 1998; not
// checked against the paper).
//
//   u* = C_mu^(1/4) k_P^(1/2),   y* = u* y / nu,   y~* = max(y*, y*_lam),   y~ = y~* nu/u*,   y*_lam = ln(E y*_lam) / kappa
//   tau_w = rho kappa u* (u_P - u_w)_t / ln(E y~*) = mu_w (u_P - u_w)_t / y,   mu_w = mu kappa y* / ln(E y~*)
//   production in the cell   tau_w u* / (rho kappa y~),   epsilon_P = u*^3 / (kappa y~)
//
// A cell centre nearer to the wall than y*_lam is treated as if it were at y*_lam, the lower end of the log layer. The standard k-epsilon
// model is not valid in the viscous layer below: there it computes a friction that is too large by half.
//
// u_t: part along the wall.
//
// A rough wall, of the equivalent sand roughness k_s, lowers the logarithm:
//
//   E -> E/(1 + a k_s*),   k_s* = u* k_s/nu,   a = E exp(-8.5 kappa)              y* not less than k_s*/2 either
//
// For large k_s* u+ = ln(y/k_s)/kappa + 8.5, Nikuradse's law of the fully rough wall (1933); the sum 1 + a k_s* joins it with the smooth
// wall as Colebrook (1939) does for pipes of commerce. Walls of uniform sand have less friction than that at k_s* of 5 to 70.
//
// The water slips in the cell at the wall, so that the slope of the pressure there follows from the curvature of the streamlines, which is
// not known. It is taken from the neighbours of the cell (solver/boundaries/wall_pressure.hpp). Limit: where the velocity differs by
// much between the cell at the wall and the next one, the pressure at a curved wall is of first order. In a ring of 12 cells between
// cylinders the cells at the walls have a velocity across them of 5 % of that along them (with zero slope 9 %), and angular momentum is
// lost: the torques of the two cylinders differ.
#include <vector>

#include "solver/turbulence/wall_faces.hpp"

namespace snag {

struct WallLaw {
  double C_mu = 0.09, kappa = 0.41, E = 9.8;
  double y_laminar = 11.53;  // y*_lam; set_y_laminar() makes it fit

  void set_y_laminar();
  /// mu_w / mu; roughness_star: k_s*.
  double viscosity_ratio(double y_star, double roughness_star = 0) const;
  /// y~, m, of a wall distance y.
  double distance(double y, double u_star, double nu, double roughness = 0) const;
  /// u*, m/s.
  double friction_speed(double k) const;
};

class WallFunctions : public WallFaces {
 public:
  WallFunctions() = default;
  /// Local.
  WallFunctions(const Mesh& mesh, const BoundarySet& boundary, const WallLaw& law);

  /// Sets mu_w in flow.face_viscosity and flow.y_plus from k [n_all_cells]. Local.
  void set_viscosity(Flow& flow, const std::vector<double>& k) const;
  /// Production, m2/s3, and epsilon, m2/s3, of the wall cells from k and the velocity of the flow; [cells().size()]. Local.
  void equilibrium(const Flow& flow, const BoundarySet& boundary, const std::vector<double>& k);

  const std::vector<double>& production() const { return production_; }
  const std::vector<double>& dissipation() const { return dissipation_; }

 private:
  WallLaw law_;
  std::vector<double> roughness_;  // k_s, of faces_, m
  std::vector<double> production_, dissipation_;
};

}  // namespace snag
