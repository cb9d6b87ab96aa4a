#include "solver/turbulence/two_equation_model.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/error.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

/// a^n + e r (a^n - a^(n-1)), or the same of 1/a where a falls.
double extrapolated(double now, double before, double step) {
  if (now >= before) return now + step * (now - before);
  return 1 / (1 / now + step * (1 / now - 1 / before));
}

bool all_zero(const Mesh& mesh, const std::vector<double>& field) {
  double largest = 0;
  for (const double value : field) largest = std::max(largest, std::abs(value));
  return maximum(mesh.comm, largest) == 0;
}

}  // namespace

double twice_strain_squared(const Mat3& G) {
  const double xy = G[0].y + G[1].x, xz = G[0].z + G[2].x, yz = G[1].z + G[2].y;
  return 2 * (G[0].x * G[0].x + G[1].y * G[1].y + G[2].z * G[2].z) + xy * xy + xz * xz + yz * yz;
}

std::vector<Parameter> TwoEquationModel::initial_parameters() {
  return {{"initial_k", &initial_k_, "m2/s2", smallest_scalar, infinity, Basis::assumed,
           "Turbulent kinetic energy at the start; by default the mean over the entering fluid."},
          {"initial_epsilon", &initial_epsilon_, "m2/s3", smallest_scalar, infinity, Basis::assumed,
           "Dissipation rate at the start; by default the mean over the entering fluid."}};
}

Parameter TwoEquationModel::tolerance_parameter() {
  return {"tolerance",
          &tolerance_,
          "1",
          1e-15,
          0.1,
          Basis::assumed,
          "Relative change of k and " + phi_.symbol + " in the last sweep of the solution (root of the mean square over the cells)."};
}

Parameter TwoEquationModel::constant(const char* key, double* target, double low, double high) {
  return {key, target, "1", low, high, Basis::literature, std::string("Constant ") + key + " of the model."};
}

void TwoEquationModel::prepare(Flow& flow, const BoundarySet& boundary, Workspace& workspace) {
  if (initial_k_.has_value() != initial_epsilon_.has_value())
    throw Error(ExitCode::usage, "[turbulence]: of initial_k and initial_epsilon only one is given; give both or none");
  const Mesh& mesh = flow.mesh;
  const auto n_all = static_cast<std::size_t>(mesh.n_all_cells()), n_boundary = static_cast<std::size_t>(mesh.n_faces - mesh.n_interior);
  workspace_ = &workspace;
  k_.equation.emplace(mesh, boundary, Side::slope, workspace, 0), phi_.equation.emplace(mesh, boundary, Side::none, workspace, 1);
  k_.now = &flow.turbulent_kinetic_energy, phi_.now = &field_of_phi(flow), epsilon_ = &flow.dissipation_rate;
  epsilon_->assign(n_all, 0), flow.eddy_viscosity.assign(n_all, 0);
  for (Scalar* scalar : {&k_, &phi_}) {
    scalar->equation->tolerance = tolerance_;
    scalar->entering.assign(n_boundary, 0);
    for (auto* field : {scalar->now, &scalar->old, &scalar->older}) field->assign(n_all, 0);
  }
  k_.guess = k_.now, phi_.guess = &workspace.scalar[2];
  flow.y_plus.assign(n_boundary, 0), flow.wall_function.assign(n_boundary, 0);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f)
      flow.wall_function[f - mesh.n_interior] = boundary.is_wall(static_cast<int>(p));
  flow.variable_viscosity = true;
  prepare_walls(flow, boundary);
}

void TwoEquationModel::start(Flow& flow, const BoundarySet& boundary) {
  const Mesh& mesh = flow.mesh;
  set_entering(flow, boundary);
  if (all_zero(mesh, *k_.now) || all_zero(mesh, *epsilon_)) fill_initial(flow, boundary);
  mesh.halo.exchange(*k_.now), mesh.halo.exchange(*epsilon_);
  const auto lowest = [&](const std::vector<double>& field) {
    double value = infinity;
    for (int c = 0; c < mesh.n_cells; ++c) value = std::min(value, field[c]);
    return minimum(mesh.comm, value);
  };
  if (const double k = lowest(*k_.now), epsilon = lowest(*epsilon_); !(k >= smallest_scalar && epsilon >= smallest_scalar))
    throw Error(ExitCode::usage, "[turbulence]: the initial k (lowest " + std::to_string(k) + " m2/s2) and epsilon (lowest " +
                                     std::to_string(epsilon) + " m2/s3) must be positive; give initial_k and initial_epsilon");
  for (std::size_t c = 0; c < phi_.now->size(); ++c) (*phi_.now)[c] = phi_of({(*k_.now)[c], (*epsilon_)[c]});
  k_.old = k_.older = *k_.now, phi_.old = phi_.older = *phi_.now;
  start_walls(flow, boundary);
  set_viscosity(flow);
}

/// As given, or the mean over what enters, weighted with the flow.
void TwoEquationModel::fill_initial(const Flow& flow, const BoundarySet& boundary) {
  const Mesh& mesh = flow.mesh;
  double k = initial_k_.value_or(0), epsilon = initial_epsilon_.value_or(0);
  if (!initial_k_) {
    std::vector<double> area, weight, weighted_k, weighted_epsilon;
    for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
      if (!boundary.is_open(static_cast<int>(p))) continue;
      for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) {
        area.push_back(norm(mesh.face_vector[f]));
        if (flow.flux[f] >= 0) continue;
        const TurbulenceValues entering = boundary.turbulence(static_cast<int>(p)).at(-flow.flux[f] / norm(mesh.face_vector[f]), C_mu_);
        weight.push_back(-flow.flux[f]);
        weighted_k.push_back(weight.back() * entering.k), weighted_epsilon.push_back(weight.back() * entering.epsilon);
      }
    }
    const double total = sum(mesh.comm, std::span<const double>(weight));
    // Where a Reynolds number of the openings is below one, it is round-off, or as good as nothing.
    const double reynolds_times_viscosity = flow.density * total / std::sqrt(sum(mesh.comm, std::span<const double>(area)));
    if (!(total > 0 && reynolds_times_viscosity > flow.dynamic_viscosity))
      throw Error(ExitCode::usage,
                  "[turbulence]: no fluid enters at the start from which k and epsilon could be taken; give initial_k and "
                  "initial_epsilon");
    k = sum(mesh.comm, std::span<const double>(weighted_k)) / total;
    epsilon = sum(mesh.comm, std::span<const double>(weighted_epsilon)) / total;
  }
  std::fill(k_.now->begin(), k_.now->end(), k);
  std::fill(epsilon_->begin(), epsilon_->end(), epsilon);
}

void TwoEquationModel::mesh_turned(Flow& flow, const BoundarySet&) {
  k_.equation->mesh_turned(), phi_.equation->mesh_turned();
  set_viscosity(flow);
}

void TwoEquationModel::begin_step(Flow&, const TimeScheme&) {
  for (Scalar* scalar : {&k_, &phi_}) std::swap(scalar->older, scalar->old), std::swap(scalar->old, *scalar->now);
}

void TwoEquationModel::begin_correction(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, int outer) {
  k_.equation->begin(flow, time), phi_.equation->begin(flow, time);
  set_entering(flow, boundary);
  guess(flow, time, outer);
  set_eddy_viscosity(flow, *k_.guess, *phi_.guess);
  set_hindrance(flow, *k_.guess);
  const std::span<double> strains = strain();
  for (int c = 0; c < flow.mesh.n_cells; ++c)
    strains[c] = twice_strain_squared(flow.velocity_gradient[c]) / (hindrance_.empty() ? 1 : 1 + hindrance_[c]);
}

TurbulenceReport TwoEquationModel::end_correction(Flow& flow, const SweepReport& k, const SweepReport& phi) {
  const Mesh& mesh = flow.mesh;
  TurbulenceReport report;
  report.equations = {{k_.symbol, k}, {phi_.symbol, phi}};
  report.raised_cells = raise(mesh);
  set_viscosity(flow);
  double largest = 0;
  for (int c = 0; c < mesh.n_cells; ++c) largest = std::max(largest, flow.eddy_viscosity[c]);
  report.largest_viscosity = maximum(mesh.comm, largest) * flow.density / flow.dynamic_viscosity;
  return report;
}

/// Rate at which fluid leaves a cell over its volume, 1/s, of the owned cells.
std::span<const double> TwoEquationModel::leaving_rate(const Flow& flow) {
  const Mesh& mesh = flow.mesh;
  const std::span<double> rate = production();  // not yet in use
  std::fill(rate.begin(), rate.end(), 0.0);
  for (int f = 0; f < mesh.n_faces; ++f) {
    const double flux = flow.flux[f] - flow.mesh_flux[f];
    rate[mesh.owner[f]] += std::max(flux, 0.0);
    if (f < mesh.n_interior) rate[mesh.neighbour[f]] += std::max(-flux, 0.0);
  }
  for (int c = 0; c < mesh.n_cells; ++c) rate[c] /= mesh.cell_volume[c];
  return rate;
}

SweepReport TwoEquationModel::solve(Scalar& scalar, const GivenCells& given) {
  return scalar.equation->solve(scalar.history(), {production(), sink(), diffusivity(), scalar.entering}, given, *scalar.now);
}

/// k* and phi*.
void TwoEquationModel::guess(Flow& flow, const TimeScheme& time, int outer) {
  const Mesh& mesh = flow.mesh;
  if (outer > 0) {
    *phi_.guess = *phi_.now;
    return;
  }
  const std::span<const double> rate = leaving_rate(flow);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const double number = time.dt * std::max(rate[c], turnover_rate(k_.old[c], phi_.old[c]));
    const double step = time.ratio * std::clamp(1.25 - 0.5 * number, 0.0, 1.0);
    (*k_.guess)[c] = extrapolated(k_.old[c], k_.older[c], step);
    (*phi_.guess)[c] = extrapolated(phi_.old[c], phi_.older[c], step);
  }
  mesh.halo.exchange(*k_.guess), mesh.halo.exchange(*phi_.guess);
}

/// k and phi of fluid that enters, by the speed of the flow through each face.
void TwoEquationModel::set_entering(const Flow& flow, const BoundarySet& boundary) {
  const Mesh& mesh = flow.mesh;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (!boundary.is_open(static_cast<int>(p))) continue;
    const InletTurbulence& inlet = boundary.turbulence(static_cast<int>(p));
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) {
      const TurbulenceValues values = inlet.at(std::abs(flow.flux[f]) / norm(mesh.face_vector[f]), C_mu_);
      k_.entering[f - mesh.n_interior] = values.k, phi_.entering[f - mesh.n_interior] = phi_of(values);
    }
  }
}

/// nu_t on a boundary face that is not a wall: of what enters, or of the cell.
double TwoEquationModel::boundary_eddy_viscosity(const Flow& flow, int f) const {
  const int b = f - flow.mesh.n_interior;
  if (flow.flux[f] >= flow.mesh_flux[f] || !(phi_.entering[b] > 0)) return flow.eddy_viscosity[flow.mesh.owner[f]];
  return entering_viscosity(k_.entering[b], phi_.entering[b]);
}

void TwoEquationModel::set_interior_viscosity(Flow& flow) {
  const Mesh& mesh = flow.mesh;
  const auto& nu_t = flow.eddy_viscosity;
  for (int f = 0; f < mesh.n_interior; ++f) {
    const double w = mesh.weight[f];
    flow.face_viscosity[f] = flow.dynamic_viscosity + flow.density * (w * nu_t[mesh.owner[f]] + (1 - w) * nu_t[mesh.neighbour[f]]);
  }
}

/// nu_t of the cells and the viscosity of the faces from k and phi as they are.
void TwoEquationModel::set_viscosity(Flow& flow) {
  const Mesh& mesh = flow.mesh;
  fill_other_fields(flow);
  set_eddy_viscosity(flow, *k_.now, *phi_.now);
  set_interior_viscosity(flow);
  set_hindrance(flow, *k_.now);
  if (!hindrance_.empty())
    for (int f = 0; f < mesh.n_interior; ++f)
      flow.face_viscosity[f] = flow.dynamic_viscosity + passing(mesh, f) * (flow.face_viscosity[f] - flow.dynamic_viscosity);
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f)
    flow.face_viscosity[f] = flow.dynamic_viscosity + flow.density * boundary_eddy_viscosity(flow, f);
  set_wall_viscosity(flow);
}

/// L s of the cells, with nu_t as it is for this k.
void TwoEquationModel::set_hindrance(const Flow& flow, const std::vector<double>& k) {
  const double root = std::pow(C_mu_, 0.25);
  hindrance_.resize(flow.screen.size());
  for (std::size_t c = 0; c < hindrance_.size(); ++c) hindrance_[c] = flow.screen[c] * flow.eddy_viscosity[c] / (root * std::sqrt(k[c]));
}

/// Raises what is too small to compute with; returns in how many cells of all ranks. Positive by construction, k and phi get there only by
/// underflow.
std::int64_t TwoEquationModel::raise(const Mesh& mesh) {
  std::vector<double>&k = *k_.now, &phi = *phi_.now;
  std::int64_t raised = 0;
  for (int c = 0; c < mesh.n_cells; ++c) {
    if (k[c] >= smallest_scalar && phi[c] >= smallest_scalar) continue;
    if (std::isnan(k[c] + phi[c])) continue;  // stays, so that the divergence is found
    k[c] = std::max(k[c], smallest_scalar), phi[c] = std::max(phi[c], smallest_scalar);
    ++raised;
  }
  raised = sum(mesh.comm, raised);
  if (raised > 0) mesh.halo.exchange(k), mesh.halo.exchange(phi);
  return raised;
}

const std::vector<Vec3>& TwoEquationModel::velocity_for_gradient(const Flow& flow, const BoundarySet& boundary) {
  velocity_for_gradient_ = boundary.values().velocity;
  walls().slip(flow, boundary, velocity_for_gradient_);
  return velocity_for_gradient_;
}

std::vector<StoredField> TwoEquationModel::stored() {
  return {{"k", k_.now}, {"k_old", &k_.old}, {phi_.symbol, phi_.now}, {phi_.symbol + "_old", &phi_.old}};
}

void TwoEquationModel::restore(Flow& flow, const BoundarySet& boundary) {
  set_entering(flow, boundary);
  set_viscosity(flow);
}

}  // namespace snag
