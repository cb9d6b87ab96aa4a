#include "solver/turbulence/k_epsilon_model.hpp"

namespace snag {

std::vector<Parameter> KEpsilonModel::common_parameters() {
  return {constant("sigma_k", &sigma_k_, 0.1, 10), constant("sigma_epsilon", &sigma_epsilon_, 0.1, 10),
          constant("kappa", &law_.kappa, 0.2, 1), constant("E", &law_.E, 2, 100), tolerance_parameter()};
}

void KEpsilonModel::prepare_walls(const Flow& flow, const BoundarySet& boundary) {
  law_.C_mu = C_mu_;
  law_.set_y_laminar();
  walls_ = WallFunctions(flow.mesh, boundary, law_);
}

TurbulenceReport KEpsilonModel::correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) {
  begin_correction(flow, boundary, time, outer);
  walls_.equilibrium(flow, boundary, *k_.guess);
  const auto set_diffusivity_over = [&](double sigma) {
    set_diffusivity(
        flow, [sigma](int) { return 1 / sigma; }, 1 / sigma);
  };

  set_diffusivity_over(sigma_epsilon_);
  set_sources_of_epsilon(flow, time.dt);
  const SweepReport of_epsilon = solve(phi_, {walls_.cells(), walls_.dissipation()});
  set_diffusivity_over(sigma_k_);
  set_sources_of_k(flow, *phi_.now);
  for (std::size_t i = 0; i < walls_.cells().size(); ++i) production()[walls_.cells()[i]] = walls_.production()[i];
  const SweepReport of_k = solve(k_, {});
  return end_correction(flow, of_k, of_epsilon);
}

}  // namespace snag
