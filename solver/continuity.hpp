#pragma once
// Continuity: fluxes without divergence from the predicted velocity, and the pressure that makes them so.
//
//   flux~ = [u* + m grad p]_f.S - m_f (S.grad p)_f + m_f (rho/dt) psi~       m = 1/(a0 rho/dt + beta): mobility, m3 s/kg
//   div(m grad p') = div(flux~),    flux = flux~ - m_f (S.grad p')_f,    u = u* - m grad p',    p <- p + p'
//
// [..]_f is interpolation, (S.grad p)_f the compact difference across the face: their difference damps pressure that alternates from cell
// to cell, and it is formed from cell values alone, so that a face needs no history. Cell gradients of pressure are of the Gauss form: the
// sum of V grad p over the cells is the pressure on the boundary. Fluxes and velocities share p', so that u balances momentum with the new
// pressure exactly.
#include <optional>

#include "solver/boundaries/boundary.hpp"
#include "solver/flux_history.hpp"
#include "solver/operators/gradient.hpp"
#include "solver/operators/poisson.hpp"

namespace snag {

struct ContinuitySettings {
  int n_non_orthogonal_correctors = 1;
  double tolerance = 1e-6, tolerance_intermediate = 1e-1;
  std::string multigrid = "boomeramg";
};

struct ContinuityReport {
  double initial = 0, final = 0;  // norm of the mass imbalance of all cells before and after, m3/s
  int iterations = 0, solves = 0;
  bool rebuilt = false;
};

class Continuity {
 public:
  Continuity(const Mesh& mesh, const BoundarySet& boundary, const ContinuitySettings& settings);

  /// Pressure gradient and boundary pressure of flow.pressure as it is given (a start). Collective.
  void start_pressure(Flow& flow, const BoundarySet& boundary);
  /// Make the given velocity and its fluxes divergence-free; the pressure stays. Collective.
  void project(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient);
  /// Again after the mesh has turned, at the begin of a step: geometry, and the gradient of the pressure there. Collective.
  void mesh_turned(Flow& flow, const BoundarySet& boundary, const TimeScheme& time);
  /// One pressure correction; `gradient` of velocity, for skewness. Collective.
  ContinuityReport correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, const std::vector<Mat3>& gradient);

  /// Take the divergence out of a guessed flux, [n_faces], relative to the mesh, to the intermediate tolerance. Collective.
  void close(std::vector<double>& flux, const Flow& flow, const BoundarySet& boundary, const TimeScheme& time);

  FluxHistory history;
  std::vector<double>
      wall_slope;  // dp/dn in force where velocity is fixed or at a symmetry, [n_faces - n_interior], Pa/m; kept in the checkpoint

  const Poisson& poisson() const { return poisson_; }
  /// What the preconditioner was last set up from: mobility, [n_cells], m3 s/kg; inertia, kg/(m3 s); angle of the turning zone, rad.
  struct PreconditionerState {
    std::vector<double> mobility;
    double inertia = 1, angle = 0;
  };
  const PreconditionerState& preconditioner() const { return preconditioner_; }
  /// Set the preconditioner up again (a resume), on the mesh as it was then. Collective.
  void restore(PreconditionerState state, const BoundarySet& boundary, double fresh_cost, bool rebuild_due);

 private:
  static Vec3 acceleration_at_wall(const Flow& flow, const BoundaryValues& values, int cell, int b);
  void give_boundary(const Flow& flow, const BoundarySet& boundary);
  void set_mobility(const Flow& flow, double inertia);
  void set_face_mobility();
  void predict_flux(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient, bool with_pressure);
  void boundary_flux(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient, bool with_pressure);
  void set_coefficients(const BoundarySet& boundary);
  struct Imbalance {
    double norm, rounding;  // of the cells' sums of fluxes; what round-off alone makes of it, m3/s
  };
  Imbalance begin_correction(const std::vector<double>& flux, const BoundarySet& boundary);
  ContinuityReport solve(Flow& flow, const BoundarySet& boundary);
  void note_preconditioner(const Flow& flow);
  void add_cross_flux();
  void correct_flux(std::vector<double>& flux);
  void correct_cells(Flow& flow, bool with_pressure);

  const Mesh& mesh_;
  ContinuitySettings settings_;
  LeastSquares squares_;
  Poisson poisson_;
  double inertia_ = 1, inertia_over_a0_ = 1;  // a0 rho/dt, rho/dt
  std::vector<double> mobility_;              // [n_all_cells]
  std::vector<double> weight_;         // of the owner's pressure at a face: in proportion to the mobilities, so that m dp/dn is continuous
  std::vector<double> face_mobility_;  // m_f, harmonic: 1/m_f = (1 - w)/m_P + w/m_N, [n_interior]
  std::vector<double> coefficient_;    // inertia m_f c: near c, whatever the step, so that the preconditioner lasts; [n_faces]
  PreconditionerState preconditioner_;
  std::vector<double> correction_;                   // p'
  std::vector<double> given_, boundary_correction_;  // p' or its slope at the boundary as given; p' there
  std::vector<Vec3> slope_, gradient_;               // of p': least squares, Gauss
  std::vector<double> imbalance_, right_side_;
};

}  // namespace snag
