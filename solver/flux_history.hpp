#pragma once
// How far the flux of a face is from its cells' velocities, carried on in time.
//
//   psi = flux - [u]_f.S          rho dpsi/dt = [grad p]_f.S - (S.grad p)_f - kappa rho psi
//
// A flux that is interpolated afresh from the cells in each step depends on the size of the step, also when that goes to zero. With psi
// inherited, the limit exists and is reached with second order. kappa, the rate of convection and diffusion through its cells, lets psi
// fade: a steady state does not depend on the step either as long as kappa dt < 1. A face without history (of the sliding interface) has
// psi = 0 and is as stable.
#include <vector>

#include "solver/fields/flow.hpp"
#include "solver/fields/time_scheme.hpp"

namespace snag {

class FluxHistory {
 public:
  explicit FluxHistory(const Mesh& mesh);

  /// Again after the facets of the mesh have changed. Local.
  void mesh_turned();
  /// What a step inherits, a0 times psi at its end without pressure; `rate` of convection and of diffusion times the volume, [2
  /// n_all_cells], m3/s.
  void begin_step(const std::vector<double>& rate, const TimeScheme& time);
  /// Keep psi of the step just done. `gradient` of velocity: that which its flux was formed with, else psi would gather the difference step
  /// by step.
  void end_step(const Flow& flow, const std::vector<Mat3>& gradient);

  /// [n_faces], m3/s, times a0.
  const std::vector<double>& inherited() const { return inherited_; }
  std::vector<double> psi, psi_old;  // [n_faces], m3/s; kept in the checkpoint

 private:
  const Mesh& mesh_;
  std::vector<double> inherited_;
};

}  // namespace snag
