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

#include "solver/turbulence/k_epsilon_model.hpp"

namespace snag {

namespace {

class KEpsilon final : public KEpsilonModel {
 public:
  static constexpr const char* name = "k_epsilon";
  KEpsilon() : KEpsilonModel(1.3) {}
  Section section() override;

 private:
  void set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& epsilon) override;
  void set_sources_of_epsilon(const Flow& flow, double dt) override;
  void set_sources_of_k(const Flow& flow, const std::vector<double>& epsilon) override;

  double C_1_ = 1.44, C_2_ = 1.92;
};

const bool registered = turbulence_models().add<KEpsilon>();

Section KEpsilon::section() {
  Section model{.name = name,
                .meaning = "Standard k-epsilon model (Launder and Spalding 1974) with scalable wall functions (Grotjans and Menter 1998).",
                .parameters = initial_parameters()};
  for (Parameter& parameter :
       std::vector<Parameter>{constant("C_mu", &C_mu_, 0.01, 1), constant("C_1", &C_1_, 0.1, 10), constant("C_2", &C_2_, 0.1, 10)})
    model.parameters.push_back(std::move(parameter));
  for (Parameter& parameter : common_parameters()) model.parameters.push_back(std::move(parameter));
  return model;
}

void KEpsilon::set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& epsilon) {
  for (std::size_t c = 0; c < k.size(); ++c) flow.eddy_viscosity[c] = C_mu_ * k[c] * k[c] / epsilon[c];
}

void KEpsilon::set_sources_of_epsilon(const Flow& flow, double dt) {
  const std::vector<double>&k = *k_.guess, &guess = *phi_.guess;
  for (int c = 0; c < flow.mesh.n_cells; ++c) {
    const double b = C_2_ / k[c], decayed = b * guess[c] * dt;
    set_sources_of_phi(c, C_1_ * C_mu_ * k[c] * strain()[c], b, 0.5 * decayed / (1 + decayed));
  }
}

void KEpsilon::set_sources_of_k(const Flow& flow, const std::vector<double>& epsilon) {
  const std::vector<double>&k = *k_.guess, &guess = *phi_.guess;
  for (int c = 0; c < flow.mesh.n_cells; ++c) {
    const double growth = 0.5 * epsilon[c] / guess[c];
    production()[c] = flow.eddy_viscosity[c] * strain()[c] / std::max(1.0, growth);
    sink()[c] = epsilon[c] / k[c];
  }
}

}  // namespace
}  // namespace snag
