// Standard k-epsilon model, Launder and Spalding (1974), with the wall functions of solver/turbulence/wall_functions.hpp:
//
//   dk/dt + div(u k) = div((nu + nu_t/sigma_k) grad k) + P - epsilon
//   d epsilon/dt + div(u epsilon) = div((nu + nu_t/sigma_epsilon) grad epsilon) + (epsilon/k) (C_1 P - C_2 epsilon)
//   nu_t = C_mu k^2/epsilon,   P = 2 nu_t S:S,   S = (grad u + grad u^T)/2
//
// One correction: epsilon with k as guessed, then k with the sink epsilon/k* of the epsilon just found, then mu_t.
//
// epsilon:  P_eps = C_1 C_mu k* 2 S:S,      s_eps = C_2 epsilon*/k*          (P/nu_t = 2 S:S, and nu_t epsilon/k = C_mu k)
// k:        P = C_mu k*^2/epsilon* 2 S:S,   s_k = epsilon/k*
//
// Where epsilon more than doubles in a step, production of k goes with epsilon/2 instead of epsilon*: in the sudden strain of an impulsive
// start k would else grow by a power of ten in a step, far ahead of the epsilon that holds it.
//
// A guess a* is extrapolated from a^n and a^(n-1), linearly where a grows and with 1/a linear where it falls: positive, and exact for the
// turnover time k/epsilon of decaying turbulence, which grows linearly. Where a step is longer than the turnover time or the Courant number
// large, the guess goes over to a^n, which is first order and robust.
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "parallel/sum.hpp"
#include "solver/turbulence/scalar_transport.hpp"
#include "solver/turbulence/turbulence.hpp"
#include "solver/turbulence/wall_functions.hpp"

namespace snag {

namespace {

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

const bool registered = turbulence_models().add<KEpsilon>();

// m2/s2 and m2/s3: far below any turbulence, far above what underflows in k^2/epsilon.
constexpr double smallest = 1e-60;

/// a^n + e r (a^n - a^(n-1)), or the same of 1/a where a falls.
double extrapolated(double now, double before, double step) {
  if (now >= before) return now + step * (now - before);
  return 1 / (1 / now + step * (1 / now - 1 / before));
}

/// 2 S:S of G, 1/s2.
double twice_strain_squared(const Mat3& G) {
  const double xy = G[0].y + G[1].x, xz = G[0].z + G[2].x, yz = G[1].z + G[2].y;
  return 2 * (G[0].x * G[0].x + G[1].y * G[1].y + G[2].z * G[2].z) + xy * xy + xz * xz + yz * yz;
}

bool all_zero(const Mesh& mesh, const std::vector<double>& field) {
  double largest = 0;
  for (const double value : field) largest = std::max(largest, std::abs(value));
  return maximum(mesh.comm, largest) == 0;
}

Section KEpsilon::section() {
  const auto constant = [](const char* key, double* target, double low, double high) {
    return Parameter{key, target, "1", low, high, Basis::literature, std::string("Constant ") + key + " of the model."};
  };
  return {.name = name,
          .meaning = "Standard k-epsilon model (Launder and Spalding 1974) with scalable wall functions (Grotjans and Menter 1998).",
          .parameters = {{"initial_k", &initial_k_, "m2/s2", smallest, infinity, Basis::assumed,
                          "Turbulent kinetic energy at the start; by default the mean over the entering fluid."},
                         {"initial_epsilon", &initial_epsilon_, "m2/s3", smallest, infinity, Basis::assumed,
                          "Dissipation rate at the start; by default the mean over the entering fluid."},
                         constant("C_mu", &law_.C_mu, 0.01, 1),
                         constant("C_1", &C_1_, 0.1, 10),
                         constant("C_2", &C_2_, 0.1, 10),
                         constant("sigma_k", &sigma_k_, 0.1, 10),
                         constant("sigma_epsilon", &sigma_epsilon_, 0.1, 10),
                         constant("kappa", &law_.kappa, 0.2, 1),
                         constant("E", &law_.E, 2, 100),
                         {"tolerance", &tolerance_, "1", 1e-15, 0.1, Basis::assumed,
                          "Relative change of k and epsilon in the last sweep of the solution (root of the mean square over the cells)."}}};
}

void KEpsilon::prepare(Flow& flow, const BoundarySet& boundary) {
  if (initial_k_.has_value() != initial_epsilon_.has_value())
    throw Error(ExitCode::usage, "[turbulence]: of initial_k and initial_epsilon only one is given; give both or none");
  const Mesh& mesh = flow.mesh;
  const auto n_all = static_cast<std::size_t>(mesh.n_all_cells()), n_boundary = static_cast<std::size_t>(mesh.n_faces - mesh.n_interior);
  law_.set_y_laminar();
  walls_ = WallFunctions(mesh, boundary, law_);
  k_equation_.emplace(mesh, boundary, Side::slope), epsilon_equation_.emplace(mesh, boundary, Side::none);
  k_equation_->tolerance = epsilon_equation_->tolerance = tolerance_;
  k_ = &flow.turbulent_kinetic_energy, epsilon_ = &flow.dissipation_rate;
  for (auto* field : {k_, epsilon_, &flow.eddy_viscosity, &k_old_, &k_older_, &k_guess_, &epsilon_old_, &epsilon_older_, &epsilon_guess_})
    field->assign(n_all, 0);
  for (auto* field : {&production_, &sink_, &strain_}) field->assign(static_cast<std::size_t>(mesh.n_cells), 0);
  for (auto* field : {&k_entering_, &epsilon_entering_, &flow.y_plus}) field->assign(n_boundary, 0);
  flow.wall_function.assign(n_boundary, 0);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f)
      flow.wall_function[f - mesh.n_interior] = boundary.is_wall(static_cast<int>(p));
  flow.variable_viscosity = true;
}

void KEpsilon::start(Flow& flow, const BoundarySet& boundary) {
  const Mesh& mesh = flow.mesh;
  set_entering(flow, boundary);
  if (all_zero(mesh, *k_) || all_zero(mesh, *epsilon_)) fill_initial(flow, boundary);
  mesh.halo.exchange(*k_), mesh.halo.exchange(*epsilon_);
  const auto lowest = [&](const std::vector<double>& field) {
    double value = infinity;
    for (int c = 0; c < mesh.n_cells; ++c) value = std::min(value, field[c]);
    return minimum(mesh.comm, value);
  };
  if (const double k = lowest(*k_), epsilon = lowest(*epsilon_); !(k >= smallest && epsilon >= smallest))
    throw Error(ExitCode::usage, "[turbulence]: the initial k (lowest " + std::to_string(k) + " m2/s2) and epsilon (lowest " +
                                     std::to_string(epsilon) + " m2/s3) must be positive; give initial_k and initial_epsilon");
  k_old_ = k_older_ = *k_, epsilon_old_ = epsilon_older_ = *epsilon_;
  set_viscosity(flow, boundary);
}

/// As given, or the mean over what enters, weighted with the flow.
void KEpsilon::fill_initial(const Flow& flow, const BoundarySet& boundary) {
  const Mesh& mesh = flow.mesh;
  double k = initial_k_.value_or(0), epsilon = initial_epsilon_.value_or(0);
  if (!initial_k_) {
    std::vector<double> weight, weighted_k, weighted_epsilon;
    for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
      if (!boundary.is_open(static_cast<int>(p))) continue;
      for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) {
        if (flow.flux[f] >= 0) continue;
        weight.push_back(-flow.flux[f]);
        weighted_k.push_back(weight.back() * k_entering_[f - mesh.n_interior]);
        weighted_epsilon.push_back(weight.back() * epsilon_entering_[f - mesh.n_interior]);
      }
    }
    const double total = sum(mesh.comm, std::span<const double>(weight));
    if (!(total > 0))
      throw Error(ExitCode::usage,
                  "[turbulence]: no fluid enters at the start from which k and epsilon could be taken; give initial_k and "
                  "initial_epsilon");
    k = sum(mesh.comm, std::span<const double>(weighted_k)) / total;
    epsilon = sum(mesh.comm, std::span<const double>(weighted_epsilon)) / total;
  }
  std::fill(k_->begin(), k_->end(), k);
  std::fill(epsilon_->begin(), epsilon_->end(), epsilon);
}

void KEpsilon::mesh_turned(Flow& flow, const BoundarySet& boundary) {
  k_equation_->mesh_turned(), epsilon_equation_->mesh_turned();
  diffusivity_.resize(static_cast<std::size_t>(flow.mesh.n_faces));
  set_viscosity(flow, boundary);
}

void KEpsilon::begin_step(Flow&, const TimeScheme&) {
  std::swap(k_older_, k_old_), std::swap(k_old_, *k_);
  std::swap(epsilon_older_, epsilon_old_), std::swap(epsilon_old_, *epsilon_);
}

TurbulenceReport KEpsilon::correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) {
  const Mesh& mesh = flow.mesh;
  TurbulenceReport report;
  k_equation_->begin(flow, time), epsilon_equation_->begin(flow, time);
  set_entering(flow, boundary);
  guess(flow, time, outer);
  for (int c = 0; c < mesh.n_cells; ++c) strain_[c] = twice_strain_squared(flow.velocity_gradient[c]);
  walls_.equilibrium(flow, boundary, k_guess_);

  set_diffusivity(flow, sigma_epsilon_);
  for (int c = 0; c < mesh.n_cells; ++c) {
    production_[c] = C_1_ * law_.C_mu * k_guess_[c] * strain_[c];
    sink_[c] = C_2_ * epsilon_guess_[c] / k_guess_[c];
  }
  const SweepReport epsilon =
      epsilon_equation_->solve({epsilon_old_, epsilon_older_, epsilon_guess_}, {production_, sink_, diffusivity_, epsilon_entering_},
                               {walls_.cells(), walls_.dissipation()}, *epsilon_);
  set_diffusivity(flow, sigma_k_);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const double growth = 0.5 * (*epsilon_)[c] / epsilon_guess_[c];
    production_[c] = flow.eddy_viscosity[c] * strain_[c] / std::max(1.0, growth);
    sink_[c] = (*epsilon_)[c] / k_guess_[c];
  }
  for (std::size_t i = 0; i < walls_.cells().size(); ++i) production_[walls_.cells()[i]] = walls_.production()[i];
  const SweepReport k = k_equation_->solve({k_old_, k_older_, k_guess_}, {production_, sink_, diffusivity_, k_entering_}, {}, *k_);

  report.equations = {{"k", k}, {"epsilon", epsilon}};
  report.raised_cells = raise(mesh);
  set_viscosity(flow, boundary);
  double largest = 0;
  for (int c = 0; c < mesh.n_cells; ++c) largest = std::max(largest, flow.eddy_viscosity[c]);
  report.largest_viscosity = maximum(mesh.comm, largest) * flow.density / flow.dynamic_viscosity;
  return report;
}

/// k*, epsilon*, and nu_t of them.
void KEpsilon::guess(Flow& flow, const TimeScheme& time, int outer) {
  const Mesh& mesh = flow.mesh;
  if (outer > 0) {
    k_guess_ = *k_, epsilon_guess_ = *epsilon_;
  } else {
    const auto rate = k_equation_->rate();
    for (int c = 0; c < mesh.n_cells; ++c) {
      const double number = time.dt * std::max(rate[c], epsilon_old_[c] / k_old_[c]);
      const double step = time.ratio * std::clamp(1.25 - 0.5 * number, 0.0, 1.0);
      k_guess_[c] = extrapolated(k_old_[c], k_older_[c], step);
      epsilon_guess_[c] = extrapolated(epsilon_old_[c], epsilon_older_[c], step);
    }
    mesh.halo.exchange(k_guess_), mesh.halo.exchange(epsilon_guess_);
  }
  for (int c = 0; c < mesh.n_all_cells(); ++c) flow.eddy_viscosity[c] = law_.C_mu * k_guess_[c] * k_guess_[c] / epsilon_guess_[c];
}

/// k and epsilon of fluid that enters, by the speed of the flow through each face.
void KEpsilon::set_entering(const Flow& flow, const BoundarySet& boundary) {
  const Mesh& mesh = flow.mesh;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (!boundary.is_open(static_cast<int>(p))) continue;
    const InletTurbulence& inlet = boundary.turbulence(static_cast<int>(p));
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) {
      const TurbulenceValues values = inlet.at(std::abs(flow.flux[f]) / norm(mesh.face_vector[f]), law_.C_mu);
      k_entering_[f - mesh.n_interior] = values.k, epsilon_entering_[f - mesh.n_interior] = values.epsilon;
    }
  }
}

/// nu_t on a boundary face that is not a wall: of what enters, or of the cell.
double KEpsilon::boundary_eddy_viscosity(const Flow& flow, int f) const {
  const int b = f - flow.mesh.n_interior;
  if (flow.flux[f] >= flow.mesh_flux[f] || !(epsilon_entering_[b] > 0)) return flow.eddy_viscosity[flow.mesh.owner[f]];
  return law_.C_mu * k_entering_[b] * k_entering_[b] / epsilon_entering_[b];
}

void KEpsilon::set_diffusivity(const Flow& flow, double sigma) {
  const Mesh& mesh = flow.mesh;
  const double nu = flow.dynamic_viscosity / flow.density;
  const auto& nu_t = flow.eddy_viscosity;
  diffusivity_.resize(static_cast<std::size_t>(mesh.n_faces));  // the number of facets changes as a mesh turns
  for (int f = 0; f < mesh.n_interior; ++f) {
    const double w = mesh.weight[f];
    diffusivity_[f] = nu + (w * nu_t[mesh.owner[f]] + (1 - w) * nu_t[mesh.neighbour[f]]) / sigma;
  }
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) diffusivity_[f] = nu + boundary_eddy_viscosity(flow, f) / sigma;
}

/// nu_t of the cells and the viscosity of the faces from k and epsilon as they are.
void KEpsilon::set_viscosity(Flow& flow, const BoundarySet&) {
  const Mesh& mesh = flow.mesh;
  auto& nu_t = flow.eddy_viscosity;
  for (int c = 0; c < mesh.n_all_cells(); ++c) nu_t[c] = law_.C_mu * (*k_)[c] * (*k_)[c] / (*epsilon_)[c];
  for (int f = 0; f < mesh.n_interior; ++f) {
    const double w = mesh.weight[f];
    flow.face_viscosity[f] = flow.dynamic_viscosity + flow.density * (w * nu_t[mesh.owner[f]] + (1 - w) * nu_t[mesh.neighbour[f]]);
  }
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f)
    flow.face_viscosity[f] = flow.dynamic_viscosity + flow.density * boundary_eddy_viscosity(flow, f);
  walls_.set_viscosity(flow, *k_);
}

/// Raises what is too small to compute with; returns in how many cells of all ranks. Positive by construction, k and epsilon get there only
/// by underflow.
std::int64_t KEpsilon::raise(const Mesh& mesh) {
  std::int64_t raised = 0;
  for (int c = 0; c < mesh.n_cells; ++c) {
    if ((*k_)[c] >= smallest && (*epsilon_)[c] >= smallest) continue;
    if (std::isnan((*k_)[c] + (*epsilon_)[c])) continue;  // stays, so that the divergence is found
    (*k_)[c] = std::max((*k_)[c], smallest), (*epsilon_)[c] = std::max((*epsilon_)[c], smallest);
    ++raised;
  }
  raised = sum(mesh.comm, raised);
  if (raised > 0) mesh.halo.exchange(*k_), mesh.halo.exchange(*epsilon_);
  return raised;
}

const std::vector<Vec3>& KEpsilon::velocity_for_gradient(const Flow& flow, const BoundarySet& boundary) {
  velocity_for_gradient_ = boundary.values().velocity;
  walls_.slip(flow, boundary, velocity_for_gradient_);
  return velocity_for_gradient_;
}

std::vector<StoredField> KEpsilon::stored() {
  return {{"k", k_}, {"k_old", &k_old_}, {"epsilon", epsilon_}, {"epsilon_old", &epsilon_old_}};
}

void KEpsilon::restore(Flow& flow, const BoundarySet& boundary) {
  set_entering(flow, boundary);
  set_viscosity(flow, boundary);
}

}  // namespace
}  // namespace snag
