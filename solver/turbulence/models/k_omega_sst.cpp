// k-omega model with transport of the shear stress, Menter, Kuntz and Langtry (2003), Turbulence, Heat and Mass Transfer 4, 625-632 ("SST
// 2003"), with the walls of solver/turbulence/automatic_walls.hpp:
//
//   dk/dt + div(u k) = div((nu + sigma_k nu_t) grad k) + P - beta* k omega,                 P = min(nu_t S^2, 10 beta* k omega)
//   d omega/dt + div(u omega) = div((nu + sigma_omega nu_t) grad omega) + alpha S^2 - beta omega^2 + (1 - F_1) C
//   nu_t = a_1 k / max(a_1 omega, S F_2),   S^2 = 2 D:D,   D = (grad u + grad u^T)/2,   C = 2 sigma_omega2 grad k . grad omega / omega
//
//   F_1 = tanh(min(max(t, v), 4 sigma_omega2 k / (C+ y^2))^4),     t = k^(1/2) / (beta* omega y),   v = 500 nu / (y^2 omega)
//   F_2 = tanh(max(2 t, v)^2),   C+ = max(C, 1e-10 1/s2)
//   with curvature_correction P and alpha S^2 times f of solver/turbulence/curvature.hpp
//   each of alpha, beta, sigma_k, sigma_omega:  F_1 (.)_1 + (1 - F_1) (.)_2
//
// y: distance from the nearest wall, of the mesh as it stands at the start; in a turning zone that of the other zone's walls is kept.
//
// One correction: omega with k and omega as guessed, then k with the omega just found, then nu_t. C is a source where it is positive and a
// sink C/omega* where it is negative. Where omega more than doubles in a step, production of k falls as in the
// k-epsilon model.
//
// Thin layers. Near a wall omega = 6 nu/(beta_1 y^2), and differences that are exact for linear fields overestimate its diffusion: with
// cells that grow by 1.2 from y+ 1 on friction in a pipe is then 7 % too low. So here
//
//   - diffusion of omega between two cells is that of the power of y through both, omega = A y^-n, n in [-1, 2] from the guess:
//       d omega/dy at the face = r (omega_N - omega_P)/(y_N - y_P),   r = n y_f^(-n-1) (y_N - y_P) / (y_P^-n - y_N^-n);  n = -1: r = 1
//   - the mean of omega^2 over a cell of thickness h exceeds omega_P^2, for y^-2 by (3 + x^2)/(3 (1 - x^2)^3), x = h/(2 y), of which the
//     part 1/(1 - x^2) is also that of the mean of S^2 in a log layer; the rest is given to the sink in the measure of the square of
//     omega_vis/omega, omega_vis = 6 nu/(beta_1 y^2)
//   - mu + mu_t between two cells is the logarithmic mean of theirs in the measure of omega_vis/omega, exact for one that is linear in y
//     under constant shear.
//
// All three are of second order and vanish away from walls.
#include <algorithm>
#include <cmath>

#include "mesh/geometry.hpp"
#include "mesh/wall_distance.hpp"
#include "solver/turbulence/automatic_walls.hpp"
#include "solver/turbulence/curvature.hpp"
#include "solver/turbulence/two_equation_model.hpp"

namespace snag {

namespace {

constexpr double least_cross_diffusion = 1e-10;  // 1/s2
constexpr double production_limit = 10;          // of P over beta* k omega
constexpr double least_change_of_y = 0.1;        // |ln(y_N/y_P)| of the faces across which fields are fitted: r is 1 within 0.5 % below
constexpr double thickest_cell = 0.5;            // x of a cell that does not touch the wall

class KOmegaSst final : public TwoEquationModel {
 public:
  static constexpr const char* name = "k_omega_sst";
  KOmegaSst() : TwoEquationModel("omega") {}
  Section section() override;
  void prepare(Flow& flow, const BoundarySet& boundary, Workspace& workspace) override;
  void mesh_turned(Flow& flow, const BoundarySet& boundary) override;
  void begin_step(Flow& flow, const TimeScheme& time) override;
  TurbulenceReport correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) override;
  WallTreatment wall_treatment() const override { return WallTreatment::automatic; }
  std::vector<StoredField> stored() override;

 private:
  std::vector<double>& field_of_phi(Flow& flow) const override {
    if (flow.model_fields.empty()) flow.model_fields.push_back({"specific_dissipation_rate", "1/s", 1, {}});
    return flow.model_fields.front().values;
  }
  double phi_of(const TurbulenceValues& values) const override { return values.k > 0 ? values.epsilon / (C_mu_ * values.k) : 0; }
  double turnover_rate(double, double omega) const override { return C_mu_ * omega; }
  double entering_viscosity(double k, double omega) const override { return k / omega; }
  void set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& omega) override;
  void prepare_walls(const Flow& flow, const BoundarySet& boundary) override;
  const WallFaces& walls() const override { return walls_; }
  void start_walls(const Flow& flow, const BoundarySet& boundary) override { walls_.find(flow, boundary, friction_velocity_); }
  void set_wall_viscosity(Flow& flow) override { walls_.set_viscosity(flow, friction_velocity_); }
  void set_interior_viscosity(Flow& flow) override;
  void fill_other_fields(Flow& flow) override;

  /// alpha, beta, sigma_k, sigma_omega.
  struct Constants {
    double alpha, beta, sigma_k, sigma_omega;
  };
  Constants blended(int c) const;
  double omega_viscous(int c, double nu) const { return 6 * nu / (near_.beta * y_[c] * y_[c]); }
  void set_blending(const Flow& flow);
  void set_diffusivity_of(const Flow& flow, double Constants::*sigma);
  void fit_diffusivity(const Mesh& mesh);
  SweepReport solve_omega(const Flow& flow);
  SweepReport solve_k(const Flow& flow);

  /// A face across which the distance from the wall changes much.
  struct FittedFace {
    int face, nearer;                // the cell nearer to the wall
    double ratio_cells, ratio_face;  // ln(y_N/y_P), ln(y_f/y_P)
  };

  bool curvature_correction_ = false;
  Curvature curvature_;
  double a_1_ = 0.31;
  Constants near_{5.0 / 9, 3.0 / 40, 0.85, 0.5}, far_{0.44, 0.0828, 1, 0.856};  // (.)_1, (.)_2
  SpaldingLaw law_;
  AutomaticWalls walls_;
  std::vector<double> y_;       // [n_all_cells], m
  std::vector<double> excess_;  // [n_cells], of the mean of omega^2 in a viscous layer, over omega_P^2
  std::vector<FittedFace> fitted_;
  std::vector<double> friction_velocity_;           // [n_all_cells], of wall cells, m/s
  std::vector<double> blending_, cross_diffusion_;  // F_1, [n_all_cells]; (1 - F_1) C, [n_cells], 1/s2
};

const bool registered = turbulence_models().add<KOmegaSst>();

Section KOmegaSst::section() {
  Section model{.name = name,
                .meaning = "k-omega SST model (Menter, Kuntz and Langtry 2003) with automatic wall treatment: y+ from below 1 to 300.",
                .parameters = initial_parameters()};
  for (Parameter& parameter : std::vector<Parameter>{
           constant("beta_star", &C_mu_, 0.01, 1), constant("a_1", &a_1_, 0.01, 10), constant("alpha_1", &near_.alpha, 0.01, 10),
           constant("beta_1", &near_.beta, 0.001, 1), constant("sigma_k1", &near_.sigma_k, 0.1, 10),
           constant("sigma_omega1", &near_.sigma_omega, 0.1, 10), constant("alpha_2", &far_.alpha, 0.01, 10),
           constant("beta_2", &far_.beta, 0.001, 1), constant("sigma_k2", &far_.sigma_k, 0.1, 10),
           constant("sigma_omega2", &far_.sigma_omega, 0.1, 10), constant("kappa", &law_.kappa, 0.2, 1), constant("E", &law_.E, 2, 100),
           constant("c_r1", &curvature_.c_r1, 0, 10), constant("c_r2", &curvature_.c_r2, 0, 100), constant("c_r3", &curvature_.c_r3, 0, 10),
           tolerance_parameter()})
    model.parameters.push_back(std::move(parameter));
  model.parameters.push_back(
      setting("curvature_correction", &curvature_correction_,
              "true: production falls where streamlines are convex and grows where they are concave, Smirnov and Menter (2009); field "
              "`production_factor`."));
  return model;
}

void KOmegaSst::prepare(Flow& flow, const BoundarySet& boundary, Workspace& workspace) {
  field_of_phi(flow);  // the first one
  if (curvature_correction_) {
    curvature_.prepare(flow.mesh, workspace.moments);
    flow.model_fields.push_back({"production_factor", "1", 0, std::vector<double>(static_cast<std::size_t>(flow.mesh.n_all_cells()), 1.0)});
  }
  TwoEquationModel::prepare(flow, boundary, workspace);
}

void KOmegaSst::mesh_turned(Flow& flow, const BoundarySet& boundary) {
  TwoEquationModel::mesh_turned(flow, boundary);
  if (curvature_correction_) curvature_.mesh_turned();
}

void KOmegaSst::begin_step(Flow& flow, const TimeScheme& time) {
  TwoEquationModel::begin_step(flow, time);
  if (curvature_correction_) curvature_.begin_step(flow);
}

void KOmegaSst::prepare_walls(const Flow& flow, const BoundarySet& boundary) {
  const Mesh& mesh = flow.mesh;
  refuse_rough_walls(flow, boundary);
  walls_ = AutomaticWalls(mesh, boundary, law_);
  friction_velocity_.assign(static_cast<std::size_t>(mesh.n_all_cells()), 0);
  std::vector<std::string> names;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    if (boundary.is_wall(static_cast<int>(p))) names.push_back(mesh.patches[p].name);
  const std::vector<WallPoint> wall = wall_distances(mesh, names);
  y_.clear(), excess_.clear(), fitted_.clear();
  for (const WallPoint& point : wall) y_.push_back(point.distance);
  for (int c = 0; c < mesh.n_cells; ++c) {
    double across = 0;  // area of the cell seen along the way to the wall
    for (const int f : row(mesh.cell_face_start, mesh.cell_face, c)) across += 0.5 * std::abs(dot(mesh.face_vector[f], wall[c].away));
    const double x = across > 0 ? std::min(thickest_cell, 0.5 * mesh.cell_volume[c] / across / y_[c]) : 0, rest = 1 - x * x;
    excess_.push_back((3 + x * x) / (3 * rest * rest) - 1);
  }
  for (int f = 0; f < mesh.first_facet; ++f) {
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    const double w = mesh.weight[f], ratio = std::log(y_[N] / y_[P]);
    if (!(std::abs(ratio) > least_change_of_y)) continue;
    fitted_.push_back({f, ratio > 0 ? P : N, ratio, std::log((w * y_[P] + (1 - w) * y_[N]) / y_[P])});
  }
}

void KOmegaSst::set_eddy_viscosity(Flow& flow, const std::vector<double>& k, const std::vector<double>& omega) {
  const double nu = flow.dynamic_viscosity / flow.density;
  for (std::size_t c = 0; c < k.size(); ++c) {
    const double y = y_[c], t = std::sqrt(k[c]) / (C_mu_ * omega[c] * y), v = 500 * nu / (y * y * omega[c]);
    const double argument = std::max(2 * t, v), F_2 = std::tanh(argument * argument);
    const double S = std::sqrt(twice_strain_squared(flow.velocity_gradient[c]));
    flow.eddy_viscosity[c] = a_1_ * k[c] / std::max(a_1_ * omega[c], S * F_2);
  }
}

void KOmegaSst::set_interior_viscosity(Flow& flow) {
  TwoEquationModel::set_interior_viscosity(flow);
  const double nu = flow.dynamic_viscosity / flow.density;
  for (const FittedFace& fitted : fitted_) {
    const double in_viscous_layer = std::min(1.0, omega_viscous(fitted.nearer, nu) / (*phi_.now)[fitted.nearer]);
    const double P = nu + flow.eddy_viscosity[flow.mesh.owner[fitted.face]], N = nu + flow.eddy_viscosity[flow.mesh.neighbour[fitted.face]];
    const double ratio = N / P - 1, mean = std::abs(ratio) < 1e-6 ? P : P * ratio / std::log1p(ratio);
    double& viscosity = flow.face_viscosity[fitted.face];
    viscosity += in_viscous_layer * (flow.density * mean - viscosity);
  }
}

void KOmegaSst::fill_other_fields(Flow& flow) {
  for (std::size_t c = 0; c < flow.dissipation_rate.size(); ++c) flow.dissipation_rate[c] = C_mu_ * (*k_.now)[c] * (*phi_.now)[c];
}

KOmegaSst::Constants KOmegaSst::blended(int c) const {
  const double F = blending_[c];
  const auto mean = [&](double near, double far) { return F * near + (1 - F) * far; };
  return {mean(near_.alpha, far_.alpha), mean(near_.beta, far_.beta), mean(near_.sigma_k, far_.sigma_k),
          mean(near_.sigma_omega, far_.sigma_omega)};
}

/// F_1 and (1 - F_1) C of the guesses.
void KOmegaSst::set_blending(const Flow& flow) {
  const double nu = flow.dynamic_viscosity / flow.density;
  const std::vector<double>&k = *k_.guess, &omega = *phi_.guess;
  const auto& grad_k = k_.equation->gradient(k, k_.entering);
  const auto& grad_omega = phi_.equation->gradient(omega, phi_.entering);
  blending_.resize(k.size()), cross_diffusion_.resize(k.size());
  for (std::size_t c = 0; c < k.size(); ++c) {
    const double y = y_[c], C = 2 * far_.sigma_omega * dot(grad_k[c], grad_omega[c]) / omega[c];
    const double t = std::sqrt(k[c]) / (C_mu_ * omega[c] * y), v = 500 * nu / (y * y * omega[c]);
    const double argument = std::min(std::max(t, v), 4 * far_.sigma_omega * k[c] / (std::max(C, least_cross_diffusion) * y * y));
    blending_[c] = std::tanh(argument * argument * argument * argument);
    cross_diffusion_[c] = (1 - blending_[c]) * C;
  }
}

void KOmegaSst::set_diffusivity_of(const Flow& flow, double Constants::*sigma) {
  const double near = near_.*sigma, far = far_.*sigma;
  set_diffusivity(
      flow, [this, near, far](int c) { return blending_[c] * near + (1 - blending_[c]) * far; }, far);
}

/// That of omega times r.
void KOmegaSst::fit_diffusivity(const Mesh& mesh) {
  const std::vector<double>& omega = *phi_.guess;
  for (const FittedFace& fitted : fitted_) {
    const double a = fitted.ratio_cells, b = fitted.ratio_face;
    const double change = std::log(omega[mesh.neighbour[fitted.face]] / omega[mesh.owner[fitted.face]]);
    const double n = std::clamp(-change / a, -1.0, 2.0);
    const double slope = std::abs(n) < 1e-6 ? 1 / a : -n / std::expm1(-n * a);
    diffusivity()[fitted.face] *= slope * std::exp(-(n + 1) * b) * std::expm1(a);
  }
}

TurbulenceReport KOmegaSst::correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) {
  begin_correction(flow, boundary, time, outer);
  if (curvature_correction_) {
    std::vector<double>& factor = flow.model_fields.back().values;
    curvature_.find(flow, time.dt, *phi_.guess, factor);
    for (int c = 0; c < flow.mesh.n_cells; ++c) strain()[c] *= factor[c];
  }
  walls_.find(flow, boundary, friction_velocity_);
  set_blending(flow);
  const SweepReport of_omega = solve_omega(flow), of_k = solve_k(flow);
  return end_correction(flow, of_k, of_omega);
}

SweepReport KOmegaSst::solve_omega(const Flow& flow) {
  const double nu = flow.dynamic_viscosity / flow.density;
  set_diffusivity_of(flow, &Constants::sigma_omega);
  fit_diffusivity(flow.mesh);
  for (int c = 0; c < flow.mesh.n_cells; ++c) {
    const Constants constants = blended(c);
    const double omega = (*phi_.guess)[c], in_viscous_layer = std::min(1.0, omega_viscous(c, nu) / omega), C = cross_diffusion_[c];
    set_sources_of_phi(c, constants.alpha * strain()[c] + std::max(C, 0.0),
                       constants.beta * (1 + in_viscous_layer * in_viscous_layer * excess_[c]), 0.5);
    sink()[c] += std::max(-C, 0.0) / omega;
  }
  const std::vector<double> at_walls = walls_.omega(flow, friction_velocity_, C_mu_, near_.beta);
  return solve(phi_, {walls_.cells(), at_walls});
}

SweepReport KOmegaSst::solve_k(const Flow& flow) {
  const std::vector<double>&omega = *phi_.now, &k = *k_.guess, &guess = *phi_.guess;
  set_diffusivity_of(flow, &Constants::sigma_k);
  for (int c = 0; c < flow.mesh.n_cells; ++c) {
    const double growth = 0.5 * omega[c] / guess[c];
    const double P = std::min(flow.eddy_viscosity[c] * strain()[c], production_limit * C_mu_ * k[c] * omega[c]);
    production()[c] = P / std::max(1.0, growth);
    sink()[c] = C_mu_ * omega[c];
  }
  return solve(k_, {});
}

std::vector<StoredField> KOmegaSst::stored() {
  std::vector<StoredField> fields = TwoEquationModel::stored();
  fields.push_back({"epsilon", epsilon()});
  fields.push_back({"friction_velocity", &friction_velocity_});
  return fields;
}

}  // namespace
}  // namespace snag
