#pragma once
// Transport of a positive scalar, in a form whose discrete solution is positive whatever the step:
//
//   d phi/dt + div(F phi) - phi div F - div(Gamma grad phi) = P - s phi,      P >= 0, s >= 0
//
// BDF2 in time, BDF1 in cells where phi fell to less than half in the last step: there BDF2 would carry the fall on, below zero.
//
// Convection: a face carries beta phi_C of its upwind cell C, beta = 1 + what the limited linear scheme adds to phi_C, over phi_C, both of
// the first guess; at most 2, as if the value upstream of C were zero, and positive because phi_D of the downwind cell is. Diffusion: D (1
// + r) (phi_N - phi_P), r = cross part over direct part of the first guess, in [-1, 1], so that no face carries phi up its slope. Both
// factors are in the matrix, which is an M-matrix: phi > 0 without clipping, after any number of Gauss-Seidel sweeps, and a cell that is
// nearly empty fills as fast as its neighbours flow in, even where phi differs by powers of ten from cell to cell. The error of the first
// guess is of second order in time where it is extrapolated, and gone in a steady state. phi div F is zero once continuity holds, and keeps
// the rest of it from acting as a source.
//
// What is left of the history enters as it is where it is positive, and as (H/phi*) phi, with the first guess phi*, where it is negative
// (Patankar 1980, section 7.2-2).
#include <span>
#include <vector>

#include "solver/boundaries/boundary.hpp"
#include "solver/fields/time_scheme.hpp"
#include "solver/operators/gradient.hpp"
#include "solver/operators/workspace.hpp"

namespace snag {

/// What drives one equation.
struct ScalarTerms {
  std::span<const double> production;   // P, [n_cells]
  std::span<const double> sink;         // s, [n_cells], 1/s
  std::span<const double> diffusivity;  // Gamma, [n_faces], m2/s
  std::span<const double> entering;     // phi where fluid enters, [n_faces - n_interior]; not read at walls and symmetries
};

/// phi at t and before, and a first guess; [n_all_cells], ghosts up to date.
struct ScalarHistory {
  std::span<const double> old, older, guess;
};

/// Cells whose value is given.
struct GivenCells {
  std::span<const int> cell;
  std::span<const double> value;
};

class ScalarTransport {
 public:
  /// `at_walls`: what gradients take for known there, Side::slope (zero) or Side::none. Of the workspace it uses the matrix, the scalars 0
  /// and 1, and for its gradient the vector `place`. Collective.
  ScalarTransport(const Mesh& mesh, const BoundarySet& boundary, Side at_walls, Workspace& workspace, int place);

  /// Again after the mesh has turned. Collective.
  void mesh_turned();
  /// The step, and the flow whose fluxes, relative to the mesh, all solutions until the next begin() take. Local.
  void begin(const Flow& flow, const TimeScheme& time) { flow_ = &flow, time_ = time; }
  /// Gradient of a first guess, [n_all_cells]; `entering` as in ScalarTerms. A solve() with the same guess takes it over. Collective.
  const std::vector<Vec3>& gradient(std::span<const double> guess, std::span<const double> entering);
  /// Solve into phi, [n_all_cells], ghosts filled; phi may be the array of the first guess. `given` cells keep their value. Collective.
  SweepReport solve(const ScalarHistory& history, const ScalarTerms& terms, const GivenCells& given, std::vector<double>& phi);

  double tolerance = 1e-8;  // root mean square of the relative changes of a sweep
  int max_sweeps = 1000;

 private:
  struct FaceBlock;
  void start_rows(const ScalarHistory& history, const ScalarTerms& terms);
  void add_interior(std::span<const double> guess, std::span<const double> diffusivity);
  void add_boundary(const ScalarTerms& terms);
  void scale_rows(std::span<const double> guess, const GivenCells& given);
  void known_at_boundary(std::span<const double> guess, std::span<const double> entering);
  double flux(int f) const { return flow_->flux[f] - flow_->mesh_flux[f]; }
  bool enters(std::size_t patch, int f) const { return open_[patch] && flux(f) < 0; }

  const Mesh& mesh_;
  std::vector<bool> open_, velocity_is_given_;  // of each patch: fluid may pass; by a given velocity
  LeastSquares squares_;
  CellMatrix& matrix_;
  const Flow* flow_ = nullptr;
  TimeScheme time_;
  std::vector<double>&diagonal_, &right_side_;  // [n_all_cells]
  std::vector<Vec3>& gradient_;                 // [n_all_cells]
  std::vector<double> known_;                   // at boundary faces, for gradients
  bool gradient_is_new_ = false;                // of the guess of the next solve()
};

}  // namespace snag
