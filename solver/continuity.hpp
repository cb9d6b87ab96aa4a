#pragma once
// Continuity: fluxes without divergence from the predicted velocity, and the pressure that makes them so.
//
//   flux~ = [u*]_f.S + sigma (m D + psi~/a0),   D = [grad p - f~]_f.S - ((S.grad p)_f - [f]_f.S)       m = dt/(a0 rho): mobility, m3 s/kg
//   m div(grad p') = div(flux~),    flux = flux~ - m (S.grad p')_f,    u = u* - m grad p',    p <- p + p'
//
// [..]_f is interpolation, (S.grad p)_f = c (p_N - p_P) + T.[g^]_f the difference across the face (solver/fields/face.hpp): D damps
// pressure that alternates from cell to cell. psi~ is what the face inherits, sigma = 1/(1 + kappa dt/(a0 C)) with the rate kappa of
// convection and diffusion through its cells (solver/flux_history.hpp). Let R multiply an error of the pressure when the compact Laplacian
// is solved for the divergence of its interpolated cell gradients, and b = 1/(1 + kappa dt/a0) an error of the velocity in the momentum
// equation. A correction multiplies the error by the roots of
//
//   x^2 - (1 + b - 2 b R + sigma (R - 1)) x + b (1 - R) (1 - sigma)
//
// With C = 1, sigma = b, they are 1 - b and b (1 - R); in long steps, with small b, they are below 1 for C < R/(R - 1). On prisms round an
// axis in 24 to 72 sectors R is 1.2 to 1.4: Gauss' gradient along the ring takes the pressures of two thirds of the radius for those in the
// middle of the faces, at half of it, and is up to 4/3 of the compact difference. With sigma = 1 the larger root would be R where b is
// small: such cells ran away in long steps, and swung from step to step in shorter ones.
//
// g^ is the Gauss gradient g of a cell; in a cell with a skew face, or aslant over a boundary face, it is the mean of g over the
// neighbours. A pressure for which c (p_N - p_P) and T.[g^]_f cancel in the sum over the faces of every cell moves no flux. Nothing bounds
// such a pressure: each correction adds to it. It is an eigenvector with the eigenvalue 1 of K = A^-1 X, with A the sum of -c (p_N - p_P)
// and X that of T.[g^]_f; n corrections for non-orthogonality multiply a pressure by 1 + K + ... + K^n instead of 1/(1 - K). With g in all
// cells K reached 1.0003 on a generated pump of two vanes: in one tetrahedron with a skew face, 66 degrees aslant over its wall, least
// squares give the pressure at two of four faces, and g depends mainly on the pressure of the cell itself. The water in this cell reached
// 268 m/s in 43 steps. With g^ no |K| is above 0.50 on that mesh.
//
// Cell gradients of pressure are of the Gauss form: the sum of V grad p over the cells is the pressure on the boundary. Fluxes and
// velocities share p', so that u balances momentum with the new pressure exactly.
//
// f is the reaction of the rags. It changes from cell to cell across a sheet, and the pressure that holds it has other gradients in the
// cells than f, which would move water. f~ takes its place in the cells: with the changes of such a pressure from cell to cell, and to the
// boundary,
//
//   phi_N - phi_P = 1/2 (f_P + f_N).d,     phi_b - phi_P = f_P.d,     dphi/dn = f_P.n where the velocity is given
//
// f~ is the Gauss gradient of phi, by the very formula of the pressure (solver/operators/gradient.hpp), and (S.grad phi)_f, compact along d
// with f~ across it, is [f]_f.S. Each cell counts from its own phi: f need not be a gradient. The sum of V f~ differs little from that of
// V f (2e-5 for a kernel of three cells); cells take the difference off in proportion to |f|. On uniform cells f~ is (1/4, 1/2, 1/4) of the
// normal part of f.
//
// The slope of the pressure at walls and where the velocity is given, explicit, with what the last correction left (a: acceleration of the
// water there, f_b: body force, both given):
//
//   dp/dn = (f_b - rho a + f).n,     with a wall function:  dp/dn = (<grad p - f~> + f).n,    <..>: mean over its neighbours at no wall
//
// Water slips past a wall function, and what leads it along a curved wall is in the gradients around; from y+ 30 down to 5 the second
// slope passes into the first, as the slip vanishes. At edges of walls the first holds.
//
// So a force that pressure can hold leaves the water at rest: exactly where it is normal to layers of hexahedra, to second order on
// tetrahedra. Sources: balanced forces, Francois et al. (2006), J. Comput. Phys. 213, 141-173; for screens and actuator discs, Rethore and
// Sorensen (2012), Wind Energy 15, 915-926.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solver/boundaries/boundary.hpp"
#include "solver/boundaries/wall_pressure.hpp"
#include "solver/flux_history.hpp"
#include "solver/operators/gradient.hpp"
#include "solver/operators/poisson.hpp"

namespace snag {

struct ContinuitySettings {
  int n_non_orthogonal_correctors = 1;
  double tolerance = 1e-6, tolerance_intermediate = 1e-1;
  Multigrid multigrid = Multigrid::boomeramg;
};

struct ContinuityReport {
  double initial = 0, final = 0;  // norm of the mass imbalance of all cells before and after, m3/s
  int iterations = 0, solves = 0;
  bool rebuilt = false;
};

class Continuity {
 public:
  /// Of the workspace it uses the vectors and the scalars, and before a step the faces.
  Continuity(const Mesh& mesh, const BoundarySet& boundary, const ContinuitySettings& settings, Workspace& workspace);

  /// Pressure gradient and boundary pressure of flow.pressure as it is given (a start). Collective.
  void start_pressure(Flow& flow, const BoundarySet& boundary);
  /// Make the given velocity and its fluxes divergence-free; the pressure stays. In a step a correction is small, and so is what oblique
  /// faces leave of it after one repetition; here it may be all of the velocity, 10 % of which one repetition left on tetrahedra.
  /// Collective.
  void project(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient, int n_non_orthogonal_correctors = 10);
  /// Again after the mesh has turned, at the begin of a step: geometry, and the gradient of the pressure there. Collective.
  void mesh_turned(Flow& flow, const BoundarySet& boundary);
  /// Before the corrections of a step, with the mesh where it is then: f~ takes the place of f in flow.reaction. Collective.
  void balance_reaction(Flow& flow);
  /// One pressure correction; `gradient` of velocity, for skewness; `is_last`: it is the last one of the step and keeps psi for the next
  /// step. Collective.
  ContinuityReport correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, const std::vector<Mat3>& gradient,
                           bool is_last);

  /// Take the divergence out of a guessed flux, [n_faces], relative to the mesh, to the intermediate tolerance. Collective.
  void close(std::vector<double>& flux, const Flow& flow, const BoundarySet& boundary, const TimeScheme& time);

  /// Gradient of the last p', Gauss, [n_all_cells], Pa/m: until another one works with the vectors of the workspace.
  const std::vector<Vec3>& correction_gradient() const { return gradient_; }
  /// Pressure at the facets of the sliding interface in the Gauss gradient, [n_interior - first_facet], Pa.
  const std::vector<double>& facet_pressure() const { return facet_pressure_; }
  /// The same from flow.pressure as it stands, at the begin of a step, so that a resumed run has the same to the bit; the flow stays.
  /// Collective.
  void find_facet_pressure(const Flow& flow, const BoundarySet& boundary);

  FluxHistory history;
  std::vector<double>
      wall_slope;  // dp/dn in force where velocity is fixed or at a symmetry, [n_faces - n_interior], Pa/m; kept in the checkpoint

  /// The f~ that the pressure of a checkpoint holds: its flow.reaction. Collective.
  void keep_held(const Flow& flow);

  const Poisson& poisson() const { return poisson_; }
  /// Of the turning zone when the preconditioner was last set up, rad.
  double preconditioner_angle() const { return preconditioner_angle_; }
  /// Set the preconditioner up again (a resume), on the mesh as it was then. Collective.
  void restore(double preconditioner_angle, const BoundarySet& boundary, double fresh_cost, bool rebuild_due);

 private:
  void find_held_by_pressure();
  void pressure_gradient(const std::vector<double>& pressure, const BoundarySet& boundary, const std::vector<double>& fixed,
                         std::vector<double>& at_boundary, std::vector<Vec3>& gradient);
  void set_boundary_of_correction(const Flow& flow, const BoundarySet& boundary);
  /// Why fluxes are predicted. A projection does not use the pressure. A projection and the last correction of a step keep psi for the next
  /// step.
  enum class Purpose { projection, correction, last_correction };
  void predict_flux(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient, Purpose purpose);
  void boundary_flux(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient, Purpose purpose);
  void carry_history();
  void set_coefficients(const BoundarySet& boundary, int first);
  struct Imbalance {
    double norm, rounding;  // of the cells' sums of fluxes; what round-off alone makes of it, m3/s
  };
  Imbalance begin_correction(const std::vector<double>& flux, const BoundaryValues& values);
  ContinuityReport solve(Flow& flow, const BoundaryValues& values, int n_non_orthogonal_correctors);
  void note_preconditioner(const Flow& flow);
  void set_right_side();
  void add_cross_flux();
  void correct_flux(std::vector<double>& flux, bool with_gradient);
  void find_closed_faces(int first);
  /// What g^ instead of g adds to the cross part of closed faces. Collective.
  void set_mean_flux(const std::vector<Vec3>& g);
  /// T of a face, m2.
  Vec3 cross_vector(int f) const { return mesh_.face_vector[f] - coefficient_[f] * mesh_.delta[f]; }
  void correct_cells(Flow& flow, bool with_pressure);

  const Mesh& mesh_;
  ContinuitySettings settings_;
  LeastSquares squares_;
  Poisson poisson_;
  double mobility_ = 1;              // m
  std::vector<double> coefficient_;  // c, [n_faces]; 0 where the boundary gives no pressure
  // f, and the f~ that the pressure holds since the last correction, N/m3, [n_all_cells]; [f]_f.S - [f~]_f.S, N/m, [n_interior]; empty
  // without a reaction
  std::vector<Vec3> reaction_, held_;
  bool reaction_is_new_ = false;  // since the last correction
  std::vector<double> reaction_excess_;
  double preconditioner_angle_ = 0;                            // rad
  std::vector<double>&correction_, &imbalance_, &right_side_;  // p', m3/s, m3/s over m; [n_all_cells]
  std::vector<Vec3>&slope_, &gradient_;                        // of p': least squares, Gauss; gradient_ also f~
  // Cells whose g^ is the mean of their neighbours: owned, ascending; 1 for these, [n_all_cells], empty where no rank has some; their
  // faces, interior, ascending; g^ - g, [n_all_cells], and T.[g^ - g]_f of the faces
  std::vector<int> closed_cells_;
  std::vector<std::uint8_t> is_closed_;
  std::vector<int> closed_faces_;
  std::vector<Vec3> to_mean_;
  std::vector<double> mean_flux_;
  std::vector<WallCell> wall_cell_;                        // [n_all_cells]
  MeanGradient mean_gradient_;                             // of velocity, while fluxes are predicted
  std::vector<double>& change_;                            // of the pressure that holds f, from cell to cell, [n_faces]
  std::vector<double> given_, boundary_correction_;        // p' or its slope at the boundary as given; p' there
  std::vector<double> facet_pressure_, facet_correction_;  // [n_interior - first_facet], p and p'
};

}  // namespace snag
