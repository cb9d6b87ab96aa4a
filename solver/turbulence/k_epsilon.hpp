#pragma once
// Standard k-epsilon model, Launder and Spalding (1974), with the wall functions of solver/turbulence/wall_functions.hpp:
//
//   dk/dt + div(u k) = div((nu + nu_t/sigma_k) grad k) + P - epsilon
//   d epsilon/dt + div(u epsilon) = div((nu + nu_t/sigma_epsilon) grad epsilon) + (epsilon/k) (C_1 P - C_2 epsilon)
//   nu_t = C_mu k^2/epsilon,   P = 2 nu_t S:S,   S = (grad u + grad u^T)/2
#include <optional>

#include "solver/turbulence/scalar_transport.hpp"
#include "solver/turbulence/turbulence.hpp"
#include "solver/turbulence/wall_functions.hpp"

namespace snag {

class KEpsilon final : public Turbulence {
 public:
  static constexpr const char* name = "k_epsilon";
  Section section() override;
  void prepare(Flow& flow, const BoundarySet& boundary) override;
  void start(Flow& flow, const BoundarySet& boundary) override;
  void mesh_turned(Flow& flow, const BoundarySet& boundary) override;
  void begin_step(Flow& flow, const TimeScheme& time) override;
  TurbulenceReport correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) override;
  const std::vector<Vec3>& velocity_for_gradient(const Flow& flow, const BoundarySet& boundary) override;
  std::vector<StoredField> stored() override;
  void restore(Flow& flow, const BoundarySet& boundary) override;

 private:
  void fill_initial(const Flow& flow, const BoundarySet& boundary);
  void guess(Flow& flow, const TimeScheme& time, int outer);
  void set_entering(const Flow& flow, const BoundarySet& boundary);
  double boundary_eddy_viscosity(const Flow& flow, int f) const;
  void set_diffusivity(const Flow& flow, double sigma);
  void set_viscosity(Flow& flow, const BoundarySet& boundary);
  std::int64_t raise(const Mesh& mesh);

  WallLaw law_;
  double C_1_ = 1.44, C_2_ = 1.92, sigma_k_ = 1, sigma_epsilon_ = 1.3, tolerance_ = 1e-8;
  std::optional<double> initial_k_, initial_epsilon_;
  WallFunctions walls_;
  std::optional<ScalarTransport> k_equation_, epsilon_equation_;
  std::vector<double>*k_ = nullptr, *epsilon_ = nullptr;  // of the flow, [n_all_cells]
  std::vector<double> k_old_, k_older_, k_guess_;         // [n_all_cells]
  std::vector<double> epsilon_old_, epsilon_older_, epsilon_guess_;
  std::vector<double> production_, sink_, strain_;     // [n_cells]; strain_: 2 S:S, 1/s2
  std::vector<double> diffusivity_;                    // [n_faces], m2/s
  std::vector<double> k_entering_, epsilon_entering_;  // [n_faces - n_interior]
  std::vector<Vec3> velocity_for_gradient_;            // likewise
};

}  // namespace snag
