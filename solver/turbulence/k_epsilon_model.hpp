#pragma once
// What models of k and epsilon with wall functions (solver/turbulence/wall_functions.hpp) share: walls, and the order of one correction,
// epsilon with k as guessed, then k with the epsilon just found, then mu_t. A model adds its sources and its nu_t.
#include "solver/turbulence/two_equation_model.hpp"
#include "solver/turbulence/wall_functions.hpp"

namespace snag {

class KEpsilonModel : public TwoEquationModel {
 public:
  TurbulenceReport correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) override;
  WallTreatment wall_treatment() const override { return WallTreatment::wall_functions; }

 protected:
  explicit KEpsilonModel(double sigma_epsilon) : TwoEquationModel("epsilon"), sigma_epsilon_(sigma_epsilon) {}

  // A model's own part.
  /// Sources of epsilon from k and epsilon as guessed, by set_sources_of_phi(). Local.
  virtual void set_sources_of_epsilon(const Flow& flow, double dt) = 0;
  /// production() and sink() of k, with k as guessed and the new epsilon. Local.
  virtual void set_sources_of_k(const Flow& flow, const std::vector<double>& epsilon) = 0;

  /// Keys of the wall functions, and sigma_k and sigma_epsilon.
  std::vector<Parameter> common_parameters();

  std::vector<double>& field_of_phi(Flow& flow) const override { return flow.dissipation_rate; }
  double phi_of(const TurbulenceValues& values) const override { return values.epsilon; }
  double turnover_rate(double k, double epsilon) const override { return epsilon / k; }
  double entering_viscosity(double k, double epsilon) const override { return C_mu_ * k * k / epsilon; }
  void prepare_walls(const Flow& flow, const BoundarySet& boundary) override;
  const WallFaces& walls() const override { return walls_; }
  void set_wall_viscosity(Flow& flow) override { walls_.set_viscosity(flow, *k_.now); }

 private:
  WallLaw law_;
  double sigma_k_ = 1, sigma_epsilon_;
  WallFunctions walls_;
};

}  // namespace snag
