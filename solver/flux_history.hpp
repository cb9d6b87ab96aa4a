#pragma once
// How far the flux of a face is from its cells' velocities, carried on in time.
//
//   psi = flux - [u]_f.S          rho dpsi/dt = [grad p]_f.S - (S.grad p)_f - kappa rho psi
//
// A flux that is interpolated afresh from the cells in each step depends on the size of the step, also when that goes to zero. With psi
// inherited, the limit exists and is reached with second order. kappa, the rate of convection and diffusion through its cells, lets psi
// fade: a steady state does not depend on the step either as long as kappa dt < 1. Where the mesh turns, the rate at which its faces sweep
// volume is added: water that turns with the mesh has no convection through its cells, yet the velocity of a cell turns at this rate.
// Without it psi would gather the differences between the pressure gradients of cells and faces for ever: in a drum that turns with its
// water the velocity of the cells drifted outwards, and Coriolis' force took 5 % of the swirl in a turn. A face without history (of the
// sliding interface) has psi = 0 and is as stable.
#include <span>
#include <vector>

#include "solver/fields/flow.hpp"
#include "solver/fields/time_scheme.hpp"
#include "solver/operators/workspace.hpp"

namespace snag {

class FluxHistory {
 public:
  /// Of the workspace it uses the last part of the vector 0 at the begin of a step.
  FluxHistory(const Mesh& mesh, Workspace& workspace);

  /// Again after the facets of the mesh have changed. Local.
  void mesh_turned();
  /// What a step inherits, a0 times psi at its end without pressure; `convection`, `diffusion`: their rates times the volume,
  /// [n_all_cells], m3/s; `mesh_flux` of the faces, m3/s. Collective.
  void begin_step(std::span<const double> convection, std::span<const double> diffusion, std::span<const double> mesh_flux,
                  const TimeScheme& time);
  /// In the last correction of a step, when the face has inherited: what gradients add to its flux (skewness_flux()), for the end of the
  /// step. Local.
  void take_skewness_flux(int f, double flux) { deviation_old[f] = flux; }
  /// Keep psi of the step just done. `gradient` of velocity: that which its flux was formed with, else psi would gather the difference step
  /// by step; of interior faces what it gave was taken. Local.
  void end_step(const Flow& flow, const std::vector<Mat3>& gradient);

  /// [n_faces], m3/s, times a0; from the begin of a step to its last correction.
  const std::vector<double>& inherited() const { return deviation_old; }
  std::vector<double> deviation, deviation_old;  // psi, [n_faces], m3/s; kept in the checkpoint. Within a step, from its begin to its end,
                                                 // what is inherited has the place of the old one, then what gradients add

 private:
  const Mesh& mesh_;
  std::span<double> swept_;  // by the faces of a cell, m3/s, [n_all_cells]
};

}  // namespace snag
