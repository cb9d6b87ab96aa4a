#pragma once
// What models of k and a second scalar phi (epsilon, omega) share: history, first guesses, entering and initial turbulence, viscosities of
// the faces, checkpoint. A model adds its equations and its walls.
//
// A guess a* is extrapolated from a^n and a^(n-1), linearly where a grows and with 1/a linear where it falls: positive, and exact for the
// turnover time k/epsilon of decaying turbulence, which grows linearly. Where a step is longer than the turnover time or the Courant number
// large, the guess goes over to a^n, which is first order and robust.
//
// The equation of phi has sources P - b phi^2, which balance at (P/b)^(1/2). With a share phi_e = s (P/b)^(1/2) of that,
//
//   b phi^2 ~ b (phi* + phi_e) phi - b phi_e phi*,      error b (phi - phi*) (phi - phi_e)
//
// With s = 0 a high phi* gives a low phi at large steps and that a high one: phi would go to and fro between phi* and P/(b phi*). With s =
// 1/2 sources alone bring it to a third of the way from the balance in each (1: the flow behind a step swings at Courant numbers of 40).
// omega has 1/2; epsilon x/(2 + 2 x), x = b phi* dt: with 1/2 and one corrector the flow behind a step wanders by 2.4 % where steps are
// short, with 0 pipes with thin cells run away where they are long.
//
// Eddies do not cross a cloth. Sheets of the loss coefficient K let a share (1 + K)^(-1/2) of the fluctuations through (Dryden and
// Schubauer (1947), J. Aeronaut. Sci. 14, 221-228, of screens), and so much of nu_t where one sheet lies within the mixing length L. A
// sheet is spread over the kernel as s = sum w A ((1 + K)^(1/2) - 1)/V, 1/m (Flow::screen); layers of a mixing length hinder one after the
// other:
//
//   nu_t of a face -> nu_t/(1 + L s),   P -> P/(1 + L s),   L = nu_t/(C_mu^(1/4) k^(1/2))
//
// Without that the jump of the velocity across a sheet makes turbulence as a free shear layer does, and the water behind it is dragged
// along.
#include <cmath>
#include <optional>

#include "solver/turbulence/scalar_transport.hpp"
#include "solver/turbulence/turbulence.hpp"
#include "solver/turbulence/wall_faces.hpp"

namespace snag {

/// k, phi: far below any turbulence, far above what underflows in k^2/epsilon.
inline constexpr double smallest_scalar = 1e-60;

/// 2 D:D of a velocity gradient, D its symmetric part, 1/s2.
double twice_strain_squared(const Mat3& G);

class TwoEquationModel : public Turbulence {
 public:
  void prepare(Flow& flow, const BoundarySet& boundary, Workspace& workspace) override;
  void start(Flow& flow, const BoundarySet& boundary) override;
  void mesh_turned(Flow& flow, const BoundarySet& boundary) override;
  void begin_step(Flow& flow, const TimeScheme& time) override;
  const std::vector<Vec3>& velocity_for_gradient(const Flow& flow, const BoundarySet& boundary) override;
  std::vector<StoredField> stored() override;
  void restore(Flow& flow, const BoundarySet& boundary) override;

 protected:
  /// k or phi.
  struct Scalar {
    std::string symbol;
    std::vector<double>* now = nullptr;    // of the flow, [n_all_cells]
    std::vector<double> old, older;        // [n_all_cells]
    std::vector<double>* guess = nullptr;  // [n_all_cells], within a correction; of k, which is solved for last, what `now` is until then
    std::vector<double> entering;          // [n_faces - n_interior]
    std::optional<ScalarTransport> equation;

    ScalarHistory history() const { return {old, older, *guess}; }
  };

  explicit TwoEquationModel(const std::string& symbol_of_phi) { k_.symbol = "k", phi_.symbol = symbol_of_phi; }

  // A model's own part.
  virtual std::vector<double>& field_of_phi(Flow& flow) const = 0;
  /// phi of k and epsilon; and the rate epsilon/k, 1/s, of k and phi.
  virtual double phi_of(const TurbulenceValues& values) const = 0;
  virtual double turnover_rate(double k, double phi) const = 0;
  /// nu_t, m2/s, without what depends on the strain: of fluid that enters.
  virtual double entering_viscosity(double k, double phi) const = 0;
  /// flow.eddy_viscosity from k and phi, [n_all_cells] of both. Collective.
  virtual void set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& phi) = 0;
  /// Walls and all else that depends on the mesh. Collective.
  virtual void prepare_walls(const Flow& flow, const BoundarySet& boundary) = 0;
  virtual const WallFaces& walls() const = 0;
  /// What the treatment of walls draws from the velocity, before the first step. Local.
  virtual void start_walls(const Flow&, const BoundarySet&) {}
  /// The viscosity of the faces of walls, and flow.y_plus. Local.
  virtual void set_wall_viscosity(Flow& flow) = 0;
  /// The viscosity of interior faces, Pa s; by default that of the cells, interpolated.
  virtual void set_interior_viscosity(Flow& flow);
  /// Beyond phi: what others read of a model that transports another scalar. Local.
  virtual void fill_other_fields(Flow&) {}

  /// Keys that all models share.
  std::vector<Parameter> initial_parameters();
  Parameter tolerance_parameter();
  static Parameter constant(const char* key, double* target, double low, double high);

  /// First part of a correction: fluxes, entering fluid, guesses, eddy viscosity of them. Collective.
  void begin_correction(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer);
  // In the workspace, within a correction:
  std::span<double> production() { return workspace_->scalar_in(workspace_->vector[2], 0); }  // [n_cells] of it, as the two below
  std::span<double> sink() { return workspace_->scalar_in(workspace_->vector[2], 1); }
  std::span<double> strain() { return workspace_->scalar_in(workspace_->vector[2], 2); }  // 2 S:S/(1 + L s), 1/s2
  std::vector<double>& diffusivity() { return workspace_->face; }                         // [n_faces], m2/s

  /// Production and sink of the equation of phi in a cell, from its sources P - b phi^2 and the share s.
  void set_sources_of_phi(int c, double P, double b, double share) {
    const double root = share * std::sqrt(P * b);  // b phi_e
    production()[c] = P + root * (*phi_.guess)[c], sink()[c] = root + b * (*phi_.guess)[c];
  }
  /// Solve the equation of k or phi with the sources and the diffusivity in the workspace. Collective.
  SweepReport solve(Scalar& scalar, const GivenCells& given);
  /// Last part: raises, viscosities, report. Collective.
  TurbulenceReport end_correction(Flow& flow, const SweepReport& k, const SweepReport& phi);
  /// Into diffusivity(): nu + sigma(c) nu_t of the cells, interpolated; in fluid that enters sigma is `entering`.
  template <class Sigma>
  void set_diffusivity(const Flow& flow, const Sigma& sigma, double entering) {
    const Mesh& mesh = flow.mesh;
    std::vector<double>& faces = workspace_->face;
    const double nu = flow.dynamic_viscosity / flow.density;
    for (int f = 0; f < mesh.n_interior; ++f) {
      const int P = mesh.owner[f], N = mesh.neighbour[f];
      const double w = mesh.weight[f];
      faces[f] = nu + passing(mesh, f) * (w * sigma(P) * flow.eddy_viscosity[P] + (1 - w) * sigma(N) * flow.eddy_viscosity[N]);
    }
    for (int f = mesh.n_interior; f < mesh.n_faces; ++f) faces[f] = nu + entering * boundary_eddy_viscosity(flow, f);
  }

  /// Dissipation rate of the flow, [n_all_cells], m2/s3.
  std::vector<double>* epsilon() const { return epsilon_; }

  Scalar k_, phi_;
  double C_mu_ = 0.09;

 private:
  void fill_initial(const Flow& flow, const BoundarySet& boundary);
  std::span<const double> leaving_rate(const Flow& flow);
  void set_entering(const Flow& flow, const BoundarySet& boundary);
  void guess(Flow& flow, const TimeScheme& time, int outer);
  double boundary_eddy_viscosity(const Flow& flow, int f) const;
  void set_viscosity(Flow& flow);
  void set_hindrance(const Flow& flow, const std::vector<double>& k);
  /// 1/(1 + L s) of an interior face.
  double passing(const Mesh& mesh, int f) const {
    if (hindrance_.empty()) return 1;
    const double w = mesh.weight[f];
    return 1 / (1 + w * hindrance_[mesh.owner[f]] + (1 - w) * hindrance_[mesh.neighbour[f]]);
  }
  std::int64_t raise(const Mesh& mesh);

  Workspace* workspace_ = nullptr;
  std::optional<double> initial_k_, initial_epsilon_;
  double tolerance_ = 1e-8;
  std::vector<double>* epsilon_ = nullptr;   // of the flow
  std::vector<Vec3> velocity_for_gradient_;  // [n_faces - n_interior]
  std::vector<double> hindrance_;            // L s, [n_all_cells]; empty without cloth
};

}  // namespace snag
