// Standard k-epsilon model, Launder and Spalding (1974), with the wall functions of solver/turbulence/wall_functions.hpp:
//
//   dk/dt + div(u k) = div((nu + nu_t/sigma_k) grad k) + P - epsilon
//   d epsilon/dt + div(u epsilon) = div((nu + nu_t/sigma_epsilon) grad epsilon) + (epsilon/k) (C_1 P - C_2 epsilon)
//   nu_t = C_mu k^2/epsilon,   P = 2 nu_t S:S,   S = (grad u + grad u^T)/2
//
// One correction: epsilon with k as guessed, then k with the sink epsilon/k* of the epsilon just found, then mu_t.
//
// epsilon:  P = C_1 C_mu k* 2 S:S,          C_2/k* epsilon^2          (P/nu_t = 2 S:S, and nu_t epsilon/k = C_mu k)
// k:        P = C_mu k*^2/epsilon* 2 S:S,   s_k = epsilon/k*
//
// Where epsilon more than doubles in a step, production of k goes with epsilon/2 instead of epsilon*: in the sudden strain of an impulsive
// start k would else grow by a power of ten in a step, far ahead of the epsilon that holds it.
#include <algorithm>
#include <cmath>

#include "solver/turbulence/two_equation_model.hpp"
#include "solver/turbulence/wall_functions.hpp"

namespace snag {

namespace {

class KEpsilon final : public TwoEquationModel {
 public:
  static constexpr const char* name = "k_epsilon";
  KEpsilon() : TwoEquationModel("epsilon") {}
  Section section() override;
  TurbulenceReport correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) override;
  WallTreatment wall_treatment() const override { return WallTreatment::wall_functions; }

 private:
  std::vector<double>& field_of_phi(Flow& flow) const override { return flow.dissipation_rate; }
  double phi_of(const TurbulenceValues& values) const override { return values.epsilon; }
  double turnover_rate(double k, double epsilon) const override { return epsilon / k; }
  double entering_viscosity(double k, double epsilon) const override { return C_mu_ * k * k / epsilon; }
  void set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& epsilon) override;
  void prepare_walls(const Flow& flow, const BoundarySet& boundary) override;
  const WallFaces& walls() const override { return walls_; }
  void set_wall_viscosity(Flow& flow) override { walls_.set_viscosity(flow, *k_.now); }
  void set_diffusivity_over(const Flow& flow, double sigma);

  WallLaw law_;
  double C_1_ = 1.44, C_2_ = 1.92, sigma_k_ = 1, sigma_epsilon_ = 1.3;
  WallFunctions walls_;
  std::vector<double> turbulent_;  // diffusivity of turbulence in the cells, [n_all_cells], m2/s
};

const bool registered = turbulence_models().add<KEpsilon>();

Section KEpsilon::section() {
  Section model{.name = name,
                .meaning = "Standard k-epsilon model (Launder and Spalding 1974) with scalable wall functions (Grotjans and Menter 1998).",
                .parameters = initial_parameters()};
  for (Parameter& parameter :
       std::vector<Parameter>{constant("C_mu", &C_mu_, 0.01, 1), constant("C_1", &C_1_, 0.1, 10), constant("C_2", &C_2_, 0.1, 10),
                              constant("sigma_k", &sigma_k_, 0.1, 10), constant("sigma_epsilon", &sigma_epsilon_, 0.1, 10),
                              constant("kappa", &law_.kappa, 0.2, 1), constant("E", &law_.E, 2, 100), tolerance_parameter()})
    model.parameters.push_back(std::move(parameter));
  return model;
}

void KEpsilon::prepare_walls(const Flow& flow, const BoundarySet& boundary) {
  law_.C_mu = C_mu_;
  law_.set_y_laminar();
  walls_ = WallFunctions(flow.mesh, boundary, law_);
}

void KEpsilon::set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& epsilon) {
  for (std::size_t c = 0; c < k.size(); ++c) flow.eddy_viscosity[c] = C_mu_ * k[c] * k[c] / epsilon[c];
}

void KEpsilon::set_diffusivity_over(const Flow& flow, double sigma) {
  turbulent_ = flow.eddy_viscosity;
  for (double& value : turbulent_) value /= sigma;
  set_diffusivity(flow, turbulent_, 1 / sigma);
}

TurbulenceReport KEpsilon::correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) {
  const Mesh& mesh = flow.mesh;
  begin_correction(flow, boundary, time, outer);
  walls_.equilibrium(flow, boundary, k_.guess);
  std::vector<double>& epsilon = *phi_.now;

  set_diffusivity_over(flow, sigma_epsilon_);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const double b = C_2_ / k_.guess[c], decayed = b * phi_.guess[c] * time.dt;
    set_sources_of_phi(c, C_1_ * C_mu_ * k_.guess[c] * strain_[c], b, 0.5 * decayed / (1 + decayed));
  }
  const SweepReport of_epsilon = phi_.equation->solve(phi_.history(), {production_, sink_, diffusivity_, phi_.entering},
                                                      {walls_.cells(), walls_.dissipation()}, epsilon);
  set_diffusivity_over(flow, sigma_k_);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const double growth = 0.5 * epsilon[c] / phi_.guess[c];
    production_[c] = flow.eddy_viscosity[c] * strain_[c] / std::max(1.0, growth);
    sink_[c] = epsilon[c] / k_.guess[c];
  }
  for (std::size_t i = 0; i < walls_.cells().size(); ++i) production_[walls_.cells()[i]] = walls_.production()[i];
  const SweepReport of_k = k_.equation->solve(k_.history(), {production_, sink_, diffusivity_, k_.entering}, {}, *k_.now);
  return end_correction(flow, of_k, of_epsilon);
}

}  // namespace
}  // namespace snag
