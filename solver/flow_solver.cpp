// One step t -> t + dt, second order: BDF2 in time, momentum with the old pressure, then pressure and fluxes, repeated n_outer_correctors
// times.
#include "solver/flow_solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

constexpr int first_step_correctors = 3;    // the first step starts from a pressure that is only a guess
constexpr double static_tolerance = 1e-13;  // of the first imbalance
constexpr int static_correctors = 20;       // each leaves about a tenth of the error by non-orthogonal faces
constexpr double exploded = 1e6;            // momentum residual over its right-hand side

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

MomentumSettings momentum_settings(const FlowSettings& settings) {
  return {.convection = settings.convection, .limiter = settings.limiter, .tolerance = settings.momentum_tolerance};
}

ContinuitySettings continuity_settings(const FlowSettings& settings) {
  return {.n_non_orthogonal_correctors = settings.n_non_orthogonal_correctors,
          .tolerance = settings.pressure_tolerance,
          .tolerance_intermediate = settings.pressure_tolerance_intermediate,
          .multigrid = settings.multigrid};
}

std::string scientific(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  return text;
}

}  // namespace

FlowSolver::FlowSolver(const Mesh& mesh, const FlowSettings& settings, std::vector<PatchBoundary> boundary,
                       std::unique_ptr<Turbulence> turbulence, std::unique_ptr<RotatingZone> rotating_zone)
    : flow(mesh),
      settings_(settings),
      boundary_(mesh, std::move(boundary)),
      workspace_(mesh),
      squares_(mesh, workspace_.moments, boundary_.velocity_sides()),
      momentum_(mesh, momentum_settings(settings), workspace_),
      continuity_(mesh, boundary_, continuity_settings(settings), workspace_),
      turbulence_(turbulence ? std::move(turbulence) : turbulence_models().make("laminar", "[turbulence]")),
      rotating_zone_(std::move(rotating_zone)),
      watch_(mesh, settings_) {
  flow.rotating_zone = rotating_zone_.get();
  if (rotating_zone_) rotating_zone_->mesh().set_mesh_flux(rotating_zone_->speed(0), flow.mesh_flux);
  flow.density = settings.density;
  flow.dynamic_viscosity = settings.viscosity();
  flow.body_force = settings.body_force;
  std::fill(flow.velocity.begin(), flow.velocity.end(), settings.initial_velocity);
  std::fill(flow.face_viscosity.begin(), flow.face_viscosity.end(), flow.dynamic_viscosity);
  turbulence_->prepare(flow, boundary_, workspace_);
}

StepReport FlowSolver::advance(double dt) {
  const bool is_start = flow.time_step_size == 0;
  initialise(flow.time);
  StepReport report;
  const double begun = seconds();
  time_ = bdf(dt, flow.time_step_size);
  begin_step(time_, report);
  const int n_outer =
      flow.time_step_size > 0 ? settings_.n_outer_correctors : std::max(settings_.n_outer_correctors, first_step_correctors);
  for (int outer = 0; outer < n_outer; ++outer) correct_once(outer, outer + 1 == n_outer, time_, report);
  flow.time += dt, flow.time_step_size = dt, ++flow.time_step;
  measure(dt, report);
  report.seconds_rest = seconds() - begun - report.seconds_momentum - report.seconds_pressure - report.seconds_turbulence;
  if (is_start) return_free_memory();  // fields that hang on the facets have moved to where they have room
  return report;
}

void FlowSolver::keep_balances(const Vec3& origin, const Vec3& axis) {
  balances_.emplace(flow.mesh, origin, axis, rotating_zone_ ? rotating_zone_->zone() : -1, workspace_);
}

void FlowSolver::advance_frozen(double dt) {
  initialise(flow.time);
  flow.velocity_older = flow.velocity_old = flow.velocity;
  flow.time += dt, flow.time_step_size = dt, ++flow.time_step;
  flow.frozen = true;
}

/// The velocity as it was given becomes divergence-free, as an impulsive start makes it.
void FlowSolver::initialise(double boundary_time) {
  if (started_) return;
  boundary_.update(flow, boundary_time);
  flow.mesh.halo.exchange(flow.velocity);
  update_gradient();
  continuity_.start_pressure(flow, boundary_);
  find_rest_pressure();
  continuity_.project(flow, boundary_, flow.velocity_gradient);
  update_gradient();
  turbulence_->start(flow, boundary_);
  watch_.begin(flow);
  started_ = true;
}

/// Where no pressure was given: that which the boundary and the body force give to water at rest, which so stays at rest as far as the
/// boundary allows. Whatever level an outlet has, the water starts from it.
void FlowSolver::find_rest_pressure() {
  const auto is_anywhere = [&](const std::vector<double>& pressure) {
    const bool here = std::any_of(pressure.begin(), pressure.end(), [](double p) { return p != 0; });
    return sum(flow.mesh.comm, std::int64_t{here}) > 0;
  };
  if (is_anywhere(flow.pressure) || (norm(flow.body_force) == 0 && !is_anywhere(boundary_.values().pressure))) return;
  const TimeScheme unit_step{.dt = flow.density};  // mobility 1: the velocity below is an acceleration times the density
  const std::vector<Mat3> no_gradient(flow.velocity.size());
  const auto velocity = flow.velocity;
  const auto reaction = std::exchange(flow.reaction, {});
  const auto wall_function = std::exchange(flow.wall_function, {});
  const auto values = boundary_.exchange_for_rest_state();
  double first = 0;
  for (int k = 0; k < static_correctors; ++k) {
    for (std::size_t c = 0; c < velocity.size(); ++c) flow.velocity[c] = flow.body_force - flow.pressure_gradient[c];
    const double imbalance = continuity_.correct(flow, boundary_, unit_step, no_gradient, false).initial;
    if (k == 0) first = imbalance;
    if (imbalance <= static_tolerance * first) break;
  }
  boundary_.restore(values);
  flow.velocity = velocity, flow.reaction = reaction, flow.wall_function = wall_function;
}

/// The mesh as it is at a time, and the fields that hang on its facets.
void FlowSolver::turn_mesh(double time) {
  if (rotating_zone_->slides()) {
    rotating_zone_->mesh().turn(rotating_zone_->angle(time));
    fields_follow_facets();
  }
  rotating_zone_->mesh().set_mesh_flux(rotating_zone_->speed(time), flow.mesh_flux);
}

void FlowSolver::fields_follow_facets() {
  const Mesh& mesh = flow.mesh;
  resize_facets(mesh, flow.flux), resize_facets(mesh, flow.flux_old);
  resize_facets(mesh, flow.face_viscosity, flow.dynamic_viscosity);
  workspace_.mesh_turned(mesh);
  continuity_.history.mesh_turned();
  squares_.update();
}

/// The mesh at the new time; shift the history, values of the boundary, first guesses.
void FlowSolver::begin_step(const TimeScheme& time, StepReport& report) {
  const double begun = seconds();
  if (rotating_zone_) turn_mesh(flow.time + time.dt);
  report.seconds_mesh = seconds() - begun;
  std::swap(flow.velocity_older, flow.velocity_old);
  std::swap(flow.velocity_old, flow.velocity);
  std::swap(flow.flux_old, flow.flux);
  boundary_.update(flow, flow.time + time.dt);
  if (slides()) {
    const double turned = seconds();
    continuity_.mesh_turned(flow, boundary_);
    turbulence_->mesh_turned(flow, boundary_);
    report.seconds_mesh += seconds() - turned;
  }
  continuity_.balance_reaction(flow);
  // Where the mesh slides its turn has found them.
  if (balances_ && !slides()) continuity_.find_facet_pressure(flow, boundary_);
  turbulence_->begin_step(flow, time);
  const double share = momentum_.guess_from_history(flow, continuity_.history, time);
  momentum_.take_given_flux(flow, boundary_);
  // At small steps the divergence of the guess is small against 1/dt, and with extrapolated fluxes a closed guess feeds noise back: it
  // doubled from step to step.
  if (share == 0 && slides()) {
    const double guessed = seconds();
    continuity_.close(momentum_.guessed_flux(), flow, boundary_, time);
    report.seconds_pressure += seconds() - guessed;
  }
  continuity_.history.begin_step(momentum_.convection_rate(), momentum_.diffusion_rate(), flow.mesh_flux, time);
}

void FlowSolver::correct_once(int outer, bool is_last, const TimeScheme& time, StepReport& report) {
  OuterReport& did = report.outer.emplace_back();
  const double begun = seconds();
  if (outer > 0) momentum_.guess_from_last(flow);
  if (is_last && balances_) balances_->take_guess(flow);
  did.momentum = momentum_.predict(flow, boundary_, time);
  if (is_last && balances_) balances_->take_limiter(momentum_);
  if (!(did.momentum.final <= exploded))
    watch_.fail(flow, boundary_, time.dt, "the momentum equation has a residual of " + scientific(did.momentum.final));
  if (!did.momentum.converged)
    log::warning("momentum equation: residual " + scientific(did.momentum.final) + " after " + std::to_string(did.momentum.sweeps) +
                 " sweeps, wanted " + scientific(settings_.momentum_tolerance) + "; take smaller steps");
  const double predicted = seconds();
  try {
    did.continuity = continuity_.correct(flow, boundary_, time, flow.velocity_gradient, is_last);
  } catch (const Error& error) {
    if (error.code == ExitCode::diverged) watch_.fail(flow, boundary_, time.dt, error.what());
    throw;
  }
  const double corrected = seconds();
  // With the gradient that the equations had.
  if (is_last && balances_) balances_->close(momentum_, flow, boundary_, time, continuity_);
  update_gradient();
  report.seconds_momentum += predicted - begun, report.seconds_pressure += corrected - predicted;
  correct_turbulence(outer, time, report);
}

void FlowSolver::correct_turbulence(int outer, const TimeScheme& time, StepReport& report) {
  const double begun = seconds();
  TurbulenceReport& did = report.outer.back().turbulence;
  did = turbulence_->correct(flow, boundary_, time, outer);
  for (const auto& [symbol, sweeps] : did.equations)
    if (!std::isfinite(sweeps.final))
      watch_.fail(flow, boundary_, time.dt, "the equation of " + symbol + " has a residual that is not a number");
  for (const auto& [symbol, sweeps] : did.equations)
    if (!sweeps.converged)
      log::warning("equation of " + symbol + ": change of " + scientific(sweeps.final) + " after " + std::to_string(sweeps.sweeps) +
                   " sweeps; take smaller steps");
  if (did.raised_cells > 0)
    log::warning("turbulence: a variable fell below its smallest usable value in " + std::to_string(did.raised_cells) +
                 " cells and was raised to it; use a shorter [time] step, or check the turbulence at inlets and at the start");
  report.seconds_turbulence += seconds() - begun;
}

void FlowSolver::update_gradient() {
  squares_.gradient(flow.velocity, turbulence_->velocity_for_gradient(flow, boundary_), flow.velocity_gradient);
}

void FlowSolver::measure(double dt, StepReport& report) {
  const Mesh& mesh = flow.mesh;
  const CellFluxes fluxes{workspace_.scalar[0], workspace_.scalar[1]};
  for (const std::span<double> field : {fluxes.net, fluxes.through}) std::fill(field.begin(), field.end(), 0.0);
  double out = 0;
  for (int f = 0; f < mesh.n_faces; ++f) {
    const double relative = std::abs(flow.flux[f] - flow.mesh_flux[f]);
    fluxes.net[mesh.owner[f]] += flow.flux[f], fluxes.through[mesh.owner[f]] += relative;
    if (f < mesh.n_interior)
      fluxes.net[mesh.neighbour[f]] -= flow.flux[f], fluxes.through[mesh.neighbour[f]] += relative;
    else
      out += flow.flux[f];
  }
  std::array<double, 2> largest{}, total{0, out};
  for (int c = 0; c < mesh.n_cells; ++c) {
    const double courant = 0.5 * dt * fluxes.through[c] / mesh.cell_volume[c];
    largest = {std::max(largest[0], std::abs(fluxes.net[c]) * dt / mesh.cell_volume[c]), std::max(largest[1], courant)};
    total[0] += courant;
  }
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), 2, MPI_DOUBLE, MPI_MAX, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, total.data(), 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
  report.continuity_local = largest[0], report.courant_max = largest[1];
  report.courant_mean = total[0] / static_cast<double>(mesh.n_cells_global), report.continuity_global = total[1];
  watch_.check(flow, boundary_, fluxes, report);
}

}  // namespace snag
