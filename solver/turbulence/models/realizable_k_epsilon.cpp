// Realizable k-epsilon model, Shih, Liou, Shabbir, Yang and Zhu (1995), Computers and Fluids 24, 227-238, with the wall functions of
// solver/turbulence/wall_functions.hpp:
//
//   dk/dt + div(u k) = div((nu + nu_t/sigma_k) grad k) + P - epsilon,                 P = nu_t S^2
//   d epsilon/dt + div(u epsilon) = div((nu + nu_t/sigma_epsilon) grad epsilon) + C_1 S epsilon - C_2 epsilon^2/(k + (nu epsilon)^(1/2))
//   nu_t = C_mu k^2/epsilon,   C_mu = 1/(A_0 + A_s U k/epsilon),   U = (D:D + W:W)^(1/2),   A_s = 6^(1/2) cos(phi)
//   phi = arccos(6^(1/2) w)/3,   w = D_ij D_jk D_ki/(D:D)^(3/2) in [-6^(-1/2), 6^(-1/2)],   S = (2 D:D)^(1/2)
//   C_1 = max(0.43, eta/(eta + 5)),   eta = S k/epsilon,   A_0 = 4,  C_2 = 1.9,  sigma_k = 1,  sigma_epsilon = 1.2
//
// D = (grad u + grad u^T)/2, W = (grad u - grad u^T)/2, of the absolute velocity: the frame does not turn. With this C_mu normal stresses
// stay positive and shear stresses obey Schwarz' inequality at any strain; a stagnation point makes less k than with a constant C_mu, and a
// round jet spreads as measured.
//
// One correction: epsilon with k as guessed, then k with production and sink of the epsilon just found, then mu_t. With production of the
// guessed epsilon, steps that are long against 1/S make k fall without end: the source of epsilon goes with epsilon, so that at such steps
// epsilon becomes C_1 S k*/C_2 whatever it was, while production would go with k*^2/epsilon*.
#include <algorithm>
#include <cmath>

#include "solver/turbulence/k_epsilon_model.hpp"

namespace snag {

namespace {

constexpr double least_C_1 = 0.43;

class RealizableKEpsilon final : public KEpsilonModel {
 public:
  static constexpr const char* name = "realizable_k_epsilon";
  RealizableKEpsilon() : KEpsilonModel(1.2) {}
  Section section() override;

 private:
  void set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& epsilon) override;
  void set_sources_of_epsilon(const Flow& flow, double dt) override;
  void set_sources_of_k(const Flow& flow, const std::vector<double>& epsilon) override;

  double A_0_ = 4, C_2_ = 1.9;
  std::vector<double> strain_limit_;  // A_s U, [n_all_cells], 1/s
};

const bool registered = turbulence_models().add<RealizableKEpsilon>();

/// A_s U of a velocity gradient, 1/s.
double strain_limit(const Mat3& G) {
  const double xy = 0.5 * (G[0].y + G[1].x), xz = 0.5 * (G[0].z + G[2].x), yz = 0.5 * (G[1].z + G[2].y);
  const double mean = (G[0].x + G[1].y + G[2].z) / 3;  // what is left of the divergence
  const Mat3 D{Vec3{G[0].x - mean, xy, xz}, Vec3{xy, G[1].y - mean, yz}, Vec3{xz, yz, G[2].z - mean}};
  const Vec3 spin{0.5 * (G[2].y - G[1].z), 0.5 * (G[0].z - G[2].x), 0.5 * (G[1].x - G[0].y)};
  const double squared = norm_squared(D[0]) + norm_squared(D[1]) + norm_squared(D[2]), U = std::sqrt(squared + 2 * norm_squared(spin));
  // D_ij D_jk D_ki = 3 det D where the trace is zero
  const double w = squared > 0 ? 3 * dot(D[0], cross(D[1], D[2])) / (squared * std::sqrt(squared)) : 0;
  const double sqrt_6 = std::sqrt(6.0), phi = std::acos(std::clamp(sqrt_6 * w, -1.0, 1.0)) / 3;
  return sqrt_6 * std::cos(phi) * U;
}

Section RealizableKEpsilon::section() {
  Section model{.name = name,
                .meaning = "Realizable k-epsilon model (Shih and others 1995) with scalable wall functions (Grotjans and Menter 1998).",
                .parameters = initial_parameters()};
  for (Parameter& parameter : std::vector<Parameter>{constant("A_0", &A_0_, 1, 10), constant("C_2", &C_2_, 0.1, 10)})
    model.parameters.push_back(std::move(parameter));
  for (Parameter& parameter : common_parameters()) model.parameters.push_back(std::move(parameter));
  return model;
}

void RealizableKEpsilon::set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& epsilon) {
  strain_limit_.resize(k.size());
  for (std::size_t c = 0; c < k.size(); ++c) {
    strain_limit_[c] = strain_limit(flow.velocity_gradient[c]);
    flow.eddy_viscosity[c] = k[c] * k[c] / (A_0_ * epsilon[c] + strain_limit_[c] * k[c]);
  }
}

void RealizableKEpsilon::set_sources_of_epsilon(const Flow& flow, double dt) {
  const double nu = flow.dynamic_viscosity / flow.density;
  for (int c = 0; c < flow.mesh.n_cells; ++c) {
    const double k = (*k_.guess)[c], e = (*phi_.guess)[c], S = std::sqrt(strain()[c]), eta = S * k / e;
    const double b = C_2_ / (k + std::sqrt(nu * e)), decayed = b * e * dt;
    set_sources_of_phi(c, std::max(least_C_1, eta / (eta + 5)) * S * e, b, 0.5 * decayed / (1 + decayed));
  }
}

void RealizableKEpsilon::set_sources_of_k(const Flow& flow, const std::vector<double>& epsilon) {
  for (int c = 0; c < flow.mesh.n_cells; ++c) {
    const double k = (*k_.guess)[c];
    production()[c] = k * k / (A_0_ * epsilon[c] + strain_limit_[c] * k) * strain()[c];
    sink()[c] = epsilon[c] / k;
  }
}

}  // namespace
}  // namespace snag
