#pragma once
// How far the flux of a face is from its cells' velocities, carried on in time.
//
//   psi = flux - [u]_f.S          rho dpsi/dt = D - kappa rho psi/C,     D = [grad p]_f.S - (S.grad p)_f
//   psi^(n+1) = sigma (m D + psi~/a0),    psi~ = - (a1 psi^n + a2 psi^(n-1)),    sigma = 1/(1 + kappa dt/(a0 C)),    m = dt/(a0 rho)
//
// kappa is the rate of convection and diffusion through its cells, as on the diagonal of the momentum equation. So psi of a steady flow,
// C D/(kappa rho), does not depend on the step, and small steps have a limit, which is reached with second order. A flux that is
// interpolated afresh from the cells in each step has psi = m D, which grows with the step: in steps of 6 degrees it added 6 % to the
// torque of a pump (docs/validation.md).
//
// C is 4 on tetrahedra and 1 on other cells, chosen by the errors in a manufactured flow (table in docs/theory.md). A mesh of tetrahedra
// has two faces a cell, and three components of velocity: a part of them has no flux. The errors of the pressure gradient move this part; D
// sees them, and more of D in the fluxes lets the pressure take less of their shape. On prisms round an axis a correction of the
// pressure is stable for C below 3.5 (solver/continuity.hpp).
//
// Where the mesh turns, the rate at which its faces sweep volume is added to kappa: water that turns with the mesh has no convection
// through its cells, yet the velocity of a cell turns at this rate. Without it psi would gather the differences between the pressure
// gradients of cells and faces for ever: in a drum that turns with its water the velocity of the cells drifted outwards, and Coriolis'
// force took 5 % of the swirl in a turn. A face without history (of the sliding interface) has psi~ = 0 and is as stable.
#include <span>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/fields/time_scheme.hpp"
#include "solver/operators/workspace.hpp"

namespace snag {

class FluxHistory {
 public:
  /// Of the workspace it uses the last part of the vector 0 at the begin of a step.
  FluxHistory(const Mesh& mesh, Workspace& workspace);

  /// Again after the facets of the mesh have changed. Local.
  void mesh_turned();
  /// sigma of a step, and what it inherits, sigma psi~/a0; `convection`, `diffusion`: their rates times the volume, [n_all_cells], m3/s;
  /// `mesh_flux` of the faces, m3/s. Collective.
  void begin_step(std::span<const double> convection, std::span<const double> diffusion, std::span<const double> mesh_flux,
                  const TimeScheme& time);
  /// In the last correction of a step: psi of the predicted flux, which takes the place of what the face inherited; then what the
  /// correction adds to it, m3/s. Local.
  void take(int f, double psi) { deviation_old[f] = psi; }
  void add(int f, double change) { deviation_old[f] += change; }
  /// The psi that was taken becomes the current one.
  void end_step() { std::swap(deviation, deviation_old); }

  /// sigma, [n_faces]; 1 before the first step.
  const std::vector<double>& pressure_share() const { return pressure_share_; }
  /// psi without pressure, [n_faces], m3/s; from the begin of a step to its last correction.
  const std::vector<double>& inherited() const { return deviation_old; }
  std::vector<double> deviation, deviation_old;  // psi, [n_faces], m3/s; kept in the checkpoint. Within a step, from its begin to its end,
                                                 // what is inherited has the place of the old one, then the new one

 private:
  void set_rate(std::span<const double> convection, std::span<const double> diffusion, std::span<const double> mesh_flux);

  const Mesh& mesh_;
  std::vector<double> pressure_share_;
  std::span<double> rate_;  // kappa/C, 1/s, [n_all_cells]
};

}  // namespace snag
