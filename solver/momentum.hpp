#pragma once
// Momentum equation: the predictor u* of a time step with the pressure gradient known so far.
//
//   rho (a0 u* + a1 u^n + a2 u^(n-1))/dt + div(rho F u*) - div(mu grad u*) + beta u* = - grad p + f + body force
//
// In a turning frame - rho omega x u is added, with the guess of u. In a sliding zone the difference in time is exact for a velocity that
// turns with it (RotatingZone::turning_difference), what BDF2 lacks of it with the guess of u.
// a0, a1, a2: BDF2 for the present and the last step size, BDF1 for the first step. F is the convecting flux relative to the mesh.
#include <array>
#include <memory>
#include <span>
#include <string>

#include "solver/boundaries/boundary.hpp"
#include "solver/convection/tetrahedra.hpp"
#include "solver/fields/time_scheme.hpp"
#include "solver/flux_history.hpp"
#include "solver/operators/gradient.hpp"
#include "solver/operators/workspace.hpp"

namespace snag {

class ConvectionScheme;
class Limiter;
struct FaceInputs;
struct MomentumFlux;

struct MomentumSettings {
  std::string convection;  // name of a scheme (solver/convection/convection.hpp)
  std::string limiter;     // name of a limiter (solver/convection/limiter.hpp)
  double tolerance = 1e-8;
  int max_sweeps = 400;
};

class Momentum {
 public:
  /// Throws Error(usage) for an unknown scheme or limiter. Of the workspace it uses the matrix and the vectors in predict(), the faces from
  /// a guess to the correction that follows, and from a guess from the history to the begin of that step two parts of the vector 0.
  Momentum(const Mesh& mesh, const MomentumSettings& settings, Workspace& workspace);

  /// First guesses of a step from its history: u and the convecting flux extrapolated in time, and in flow.velocity_gradient the gradients
  /// for the explicit terms; that of the begin becomes the old one. `history`: how far fluxes were from their cells' velocities; used where
  /// faces turn. Returns the share of the flux's extrapolation, 0 at large steps. Collective.
  double guess_from_history(Flow& flow, const FluxHistory& history, const TimeScheme& time);
  /// The convecting flux as it was guessed, relative to the mesh, [n_faces], m3/s.
  std::vector<double>& guessed_flux() { return flux_; }
  /// Where a turning face has a given flux, that of the new time: a guess from the past is that of the face as it lay then. Local.
  void take_given_flux(const Flow& flow, const BoundarySet& boundary);
  /// First guesses from the last corrector (flow.velocity, flow.velocity_gradient, flow.flux).
  void guess_from_last(const Flow& flow);
  /// Solve for u*, from flow.velocity as first guess into flow.velocity, ghosts too, with the explicit terms of flow.velocity_gradient;
  /// fills flow.boundary_friction, boundary_convection. Collective.
  SweepReport predict(Flow& flow, const BoundarySet& boundary, const TimeScheme& time);

  /// Factors of the limiter, of the components of each cell, [n_all_cells]: from predict() until the vectors of the workspace have other
  /// values, and to be put back before fluxes().
  std::vector<Vec3>& limiter_factors() { return psi_; }
  /// Momentum through the interior faces first, first + 1 ... as it stood in the equation: `guess` is the velocity before predict(),
  /// `predicted` that behind it; flow.velocity_gradient still is what it was. Local.
  void fluxes(const Flow& flow, const std::vector<Vec3>& guess, const std::vector<Vec3>& predicted, int first,
              std::span<MomentumFlux> flux) const;
  /// The convecting flux in force, relative to the mesh, [n_faces], m3/s.
  const std::vector<double>& convecting_flux() const { return flux_; }
  /// Rates of convection and of diffusion times the volume, [n_all_cells], m3/s, of the last guess from the history.
  std::span<const double> convection_rate() const { return convection_rate_; }
  std::span<const double> diffusion_rate() const { return diffusion_rate_; }

 private:
  struct BoundaryFace;  // coefficients of one boundary face
  void guess_flux(const Flow& flow, const FluxHistory& history);
  void extrapolate_flux(const Flow& flow, const FluxHistory& history, double share);
  void set_convection_rate();
  void set_diffusion_rate(const Flow& flow);
  double flux_share(const Flow& flow, const TimeScheme& time) const;
  void limit(const Flow& flow, const BoundarySet& boundary);
  FaceInputs inputs(const Flow& flow, const std::vector<Vec3>& guess) const;
  void start_rows(const Flow& flow, const TimeScheme& time);
  void add_boundary(Flow& flow, const BoundarySet& boundary);
  void record_boundary(Flow& flow, const BoundarySet& boundary) const;

  const Mesh& mesh_;
  MomentumSettings settings_;
  std::shared_ptr<const ConvectionScheme> scheme_;
  std::shared_ptr<const Limiter> limiter_;
  CellMatrix& matrix_;
  std::vector<Vec3>&diagonal_, &right_side_;  // [n_all_cells], the ghosts' parts are not used
  std::vector<Vec3>& psi_;                    // limiter
  std::vector<CoupledRow> coupled_;           // of cells at symmetry planes that lie aslant
  MeanGradient mean_gradient_;                // for a guess of the flux
  TetrahedronReconstruction reconstruction_;
  const std::vector<Mat3>* convected_ = nullptr;  // of the last prediction
  std::span<double> convection_rate_, diffusion_rate_;
  std::vector<double>& flux_;            // F, relative to the mesh, [n_faces], m3/s
  std::vector<std::uint8_t> in_corner_;  // [n_all_cells] 1 for cells in a corner
  bool has_periods_ = false;             // faces of this rank are joined across a period
};

}  // namespace snag
