#pragma once
// Balance of angular momentum of each zone and of mechanical energy, in every step, from the terms of the momentum equation as it was
// solved.
//
// The equation of a cell c, with the outward sign s of its faces:
//
//   d(rho V u)/dt + sum_f s M_f + sum_f s p_f S_f - V f = residual      M_f: momentum that passes face f, carried and by friction, N
//
// 1. Angular momentum about the axis (point x_0, unit vector a), r = x - x_0. a.r_c x (equation), summed over the cells of a zone:
//
//   stored + openings + interface + walls + lost - given = residual                                                           N m
//
//   stored     d/dt sum_c rho V a.(r_c x u_c), by the differences in time of the step, each r_c where the cell was then
//   openings   sum a.r_b x (M_b + p_b S_b) over the faces where water passes, r_b their centres
//   interface  sum +- a.r_f x (M_f + p_f S_f) over the facets: what leaves one zone enters the other
//   walls      the same over the faces of walls and planes of symmetry: the torque of the water on them, by pressure and by friction
//   given      sum V a.r_c x f, by rags and the body force
//   lost       - sum_c sum_f s a.(r_f - r_c) x (M_f + p_f S_f), and what follows for moving cells below
//
// Momentum leaves a cell at its faces, while the scheme has it at the centre: between the two the angular momentum r x u is not that of u.
// The sums over the faces of one cell vanish for u, p and a symmetric stress that are linear, so that `lost` is of second order, and
// positive where the scheme takes angular momentum that is positive. It has three parts:
//
//   convection  with M_f of convection. In a sliding zone r_c moves: r_c x d(rho V u)/dt is `stored` and - rho V w x u, w the velocity of
//               the cell; the faces of a cell, which carry F - F_mesh, sum to the same. In a frame Coriolis' force is this term.
//   pressure    with p_f S_f. The pressure at inner faces is not needed: sum_f s p_f S_f = V grad p of the cell, so that the sum is that
//               over the boundary and the facets, less sum_c a.r_c x V grad p.
//   friction    with M_f of friction. Where mu is constant the equation omits div(mu grad u^T), which is zero, while the stress
//               mu (grad u + grad u^T) is that of walls, openings and interface; its omitted part there is in `lost` too, and cancels.
//
// A period that is not along the axis carries angular momentum from one side to the other; it is in no term.
//
// 2. Energy, u_c.(equation) over all cells, by sums of differences over faces:
//
//   shaft + given = hydraulic + stored + dissipation + numerical + residual                                                      W
//
//   shaft        - sum over walls u_w.(M_b + p_b S_b): power of the moving walls on the water
//   hydraulic    sum over openings (p_b + rho u_b^2/2) F_b + u_b.M_b,friction
//   stored       d/dt sum_c rho V u^2/2
//   dissipation  sum over inner faces M_f,friction.(u_P - u_N), by mu and by mu_t as these share mu_eff of the face; and between walls and
//                the centres of their cells, (u_P - u_w).M_b: there a wall function stands for both
//   numerical    what the scheme takes, in parts:
//     convection   sum over inner faces M_f,convection.(u_P - u_N), and at openings u_P.M_b - F_b u_b^2/2: what upwinding and limiters take
//     time         sum rho V (u.du/dt - d(u^2/2)/dt) in differences: BDF2 damps
//     pressure     sum V u.grad p less what the boundary does, p_b F_b: u of the cells is not quite free of divergence
//     friction     of the omitted part of the stress, zero where it is not omitted
//
// Water with turbulence: the energy is that of the mean flow; what mu_t takes becomes turbulence before it becomes heat. p holds 2/3 rho k.
#include <array>
#include <vector>

#include "base/single.hpp"
#include "solver/boundaries/boundary.hpp"
#include "solver/continuity.hpp"
#include "solver/fields/time_scheme.hpp"
#include "solver/momentum.hpp"
#include "solver/operators/workspace.hpp"

namespace snag {

/// Of one zone in one step, about the axis, N m; the same on every rank.
struct AngularMomentumBalance {
  double stored = 0, openings = 0, interface = 0, given = 0;
  std::vector<double> wall_pressure, wall_friction;  // of each patch, zero where it is none of walls
  double lost_convection = 0, lost_pressure = 0, lost_friction = 0;

  double walls() const;
  double lost() const { return lost_convection + lost_pressure + lost_friction; }
  double residual() const { return stored + openings + interface + walls() + lost() - given; }
};

/// Of the whole domain in one step, W; the same on every rank.
struct EnergyBalance {
  double shaft = 0, given = 0, hydraulic = 0, stored = 0;
  double dissipation_viscous = 0, dissipation_turbulent = 0, dissipation_walls = 0;
  double numerical_convection = 0, numerical_time = 0, numerical_pressure = 0, numerical_friction = 0;

  double dissipation() const { return dissipation_viscous + dissipation_turbulent + dissipation_walls; }
  double numerical() const { return numerical_convection + numerical_time + numerical_pressure + numerical_friction; }
  double residual() const { return shaft + given - hydraulic - stored - dissipation() - numerical(); }
};

class Balances {
 public:
  /// `turning`: index of the zone that turns, -1 if none does. Of the workspace close() uses the vectors. Collective.
  Balances(const Mesh& mesh, const Vec3& origin, const Vec3& axis, int turning, Workspace& workspace);

  /// Before the last solution of the momentum equation in a step, and behind it. Local.
  void take_guess(const Flow& flow);
  void take_limiter(Momentum& momentum);
  /// Behind the last correction of the pressure, before that of turbulence; flow.time is still that of the begin of the step. Collective.
  void close(Momentum& momentum, const Flow& flow, const BoundarySet& boundary, const TimeScheme& time, const Continuity& continuity);

  /// Of the cells that turn and of those at rest.
  const AngularMomentumBalance& turning() const { return zone_[0]; }
  const AngularMomentumBalance& at_rest() const { return zone_[1]; }
  const EnergyBalance& energy() const { return energy_; }
  /// Torque of the turning walls on the water, N m.
  double shaft_torque() const { return shaft_torque_; }
  /// True if a patch has faces at cells that turn (0), at cells at rest (1); and if there are such cells at all.
  bool has_faces(int zone, int patch) const { return has_faces_[zone][patch] > 0; }
  bool has_cells(int zone) const { return has_cells_[zone] > 0; }

 private:
  struct Step;  // what the sums read
  void add_cells(const Step& step);
  void add_inner_faces(const Step& step);
  void add_energy(const Step& step, int f, const Vec3& difference, const MomentumFlux& flux, const Vec3& omitted);
  void add_boundary(const Step& step);
  void sum_over_ranks();
  int zone_of(int cell) const { return mesh_.cell_zone[cell] == turning_zone_ ? 0 : 1; }
  double torque(const Vec3& r, const Vec3& force) const { return dot(axis_, cross(r, force)); }

  const Mesh& mesh_;
  Vec3 origin_, axis_;
  int turning_zone_;
  std::array<AngularMomentumBalance, 2> zone_;
  EnergyBalance energy_;
  double shaft_torque_ = 0;
  std::vector<Vec3>&guess_, &predicted_;  // [n_all_cells], velocity before and behind the momentum equation, while close() works
  // How the fluxes were made, from the momentum equation to close(); in single precision. The velocity less that of the step before.
  std::vector<SingleVec3> kept_guess_, kept_factors_;
  std::array<std::vector<int>, 2> has_faces_;
  std::array<int, 2> has_cells_{};
};

}  // namespace snag
