// Pressure correction; the equations stand in the header.
//
// Non-orthogonal part of (S.grad p')_f: m_f T.[grad p']_f from the solution before, repeated n_non_orthogonal_correctors times. The flux is
// corrected with the very terms of the last solve: each cell's imbalance is the residual of that linear equation, whatever the mesh.
#include "solver/continuity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/room.hpp"
#include "parallel/running_sum.hpp"
#include "parallel/sum.hpp"
#include "solver/fields/face.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace {

// Of the fluxes through a cell's faces, and of what goes along boundary faces, whose part through a wall is rounding. No solve can be asked
// for less.
constexpr double rounding = 1e-15;

/// In several sums: one would wait for itself at each number.
double sum_of_squares(const double* number, int n) {
  double squares = 0;
#pragma omp simd reduction(+ : squares)
  for (int i = 0; i < n; ++i) squares += number[i] * number[i];
  return squares;
}

Poisson::Arrays working_arrays(Workspace& workspace) {
  const auto array = [&](std::size_t part) { return workspace.scalar_in(workspace.vector[2], part); };
  return {.residual = array(0), .direction = array(1), .product = array(2)};
}

}  // namespace

Continuity::Continuity(const Mesh& mesh, const BoundarySet& boundary, const ContinuitySettings& settings, Workspace& workspace)
    : history(mesh, workspace),
      wall_slope(mesh.n_faces - mesh.n_interior),
      mesh_(mesh),
      settings_(settings),
      squares_(mesh, workspace.moments, boundary.pressure_sides()),
      poisson_(mesh, settings.multigrid, !boundary.fixes_pressure(), working_arrays(workspace)),
      coefficient_(mesh.n_faces),
      correction_(workspace.scalar[0]),
      imbalance_(workspace.scalar[1]),
      right_side_(workspace.scalar[2]),
      slope_(workspace.vector[0]),
      gradient_(workspace.vector[1]),
      closed_cells_(closed_cells(mesh, squares_)),
      wall_cell_(wall_cells(mesh, boundary)),
      mean_gradient_(workspace.mean_gradient()),
      change_(workspace.face),
      given_(mesh.n_faces - mesh.n_interior),
      boundary_correction_(mesh.n_faces - mesh.n_interior) {
  if (sum(mesh.comm, static_cast<std::int64_t>(closed_cells_.size())) > 0) {
    std::vector<double> closed(static_cast<std::size_t>(mesh.n_all_cells()));
    for (const int c : closed_cells_) closed[c] = 1;
    mesh.halo.exchange(closed);
    is_closed_.assign(closed.begin(), closed.end());
    to_mean_.resize(closed.size());
  }
  set_coefficients(boundary, 0);
}

void Continuity::start_pressure(Flow& flow, const BoundarySet& boundary) {
  mesh_.halo.exchange(flow.pressure);
  pressure_gradient(flow.pressure, boundary, boundary.values().pressure, flow.boundary_pressure, flow.pressure_gradient);
}

void Continuity::find_facet_pressure(const Flow& flow, const BoundarySet& boundary) {
  std::vector<double> at_boundary = flow.boundary_pressure;
  std::vector<Vec3> gradient = flow.pressure_gradient;
  pressure_gradient(flow.pressure, boundary, flow.boundary_pressure, at_boundary, gradient);
}

/// Gauss gradient of a pressure whose ghosts are up to date, with the `fixed` values where the boundary fixes it; fills the values at the
/// boundary and at facets.
void Continuity::pressure_gradient(const std::vector<double>& pressure, const BoundarySet& boundary, const std::vector<double>& fixed,
                                   std::vector<double>& at_boundary, std::vector<Vec3>& gradient) {
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const int b = f - mesh_.n_interior;
      given_[b] = boundary.pressure_side(static_cast<int>(p)) == Side::value ? fixed[b] : wall_slope[b];
    }
  facet_pressure_.resize(static_cast<std::size_t>(mesh_.n_interior - mesh_.first_facet));
  squares_.gradient(pressure, given_, slope_);
  fill_boundary(mesh_, squares_, pressure, slope_, given_, at_boundary);
  gauss_gradient(mesh_, squares_, pressure, at_boundary, slope_, gradient, facet_pressure_);
}

void Continuity::mesh_turned(Flow& flow, const BoundarySet& boundary) {
  squares_.update();
  set_coefficients(boundary, mesh_.first_facet);
  start_pressure(flow, boundary);
}

void Continuity::project(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient, int n_non_orthogonal_correctors) {
  mobility_ = 1;
  predict_flux(flow, boundary, gradient, Purpose::projection);
  // Where water enters or leaves as given, the velocity of the cell becomes that of the boundary.
  std::fill(given_.begin(), given_.end(), 0.0);
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    if (!boundary.is_open(static_cast<int>(p)) || boundary.flux(static_cast<int>(p)) != FaceFlux::given) continue;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f)
      given_[f - mesh_.n_interior] = (dot(flow.velocity[mesh_.owner[f]], mesh_.face_vector[f]) - flow.flux[f]) / norm(mesh_.face_vector[f]);
  }
  solve(flow, boundary.values(), std::max(settings_.n_non_orthogonal_correctors, n_non_orthogonal_correctors));
  correct_cells(flow, false);
  carry_history();
}

ContinuityReport Continuity::correct(Flow& flow, const BoundarySet& boundary, const TimeScheme& time, const std::vector<Mat3>& gradient,
                                     bool is_last) {
  mobility_ = time.dt / (time.now * flow.density);
  predict_flux(flow, boundary, gradient, is_last ? Purpose::last_correction : Purpose::correction);
  set_boundary_of_correction(flow, boundary);
  const ContinuityReport report = solve(flow, boundary.values(), settings_.n_non_orthogonal_correctors);
  correct_cells(flow, true);
  if (reaction_is_new_) keep_held(flow);
  if (is_last) carry_history();
  return report;
}

void Continuity::keep_held(const Flow& flow) {
  reaction_is_new_ = false;
  const bool any = std::any_of(flow.reaction.begin(), flow.reaction.end(), [](const Vec3& force) { return force != Vec3{}; });
  held_.clear();
  if (sum(mesh_.comm, std::int64_t{any}) == 0) return;
  held_ = flow.reaction;
  held_.resize(static_cast<std::size_t>(mesh_.n_all_cells()));
  mesh_.halo.exchange(held_);
}

/// p' at the boundary: the change of the fixed pressure, or of the normal slope.
void Continuity::set_boundary_of_correction(const Flow& flow, const BoundarySet& boundary) {
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    const bool fixed = boundary.pressure_side(static_cast<int>(p)) == Side::value,
               slips = boundary.velocity_side(static_cast<int>(p)) == Side::mirror;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const int P = mesh_.owner[f], b = f - mesh_.n_interior;
      if (fixed) {
        given_[b] = boundary.values().pressure[b] - flow.boundary_pressure[b];
        continue;
      }
      const Vec3 given = reaction_.empty() ? Vec3{} : reaction_[P];
      const bool has_wall_function = !flow.wall_function.empty() && flow.wall_function[b] != 0;
      const double share = has_wall_function ? share_of_slip(flow.y_plus[b]) : 0;
      std::optional<double> around;
      if (share > 0) around = slope_at_wall_function(mesh_, wall_cell_, flow, held_, f);
      const Vec3 out = unit(mesh_.face_vector[f]);
      double slope = dot(
          flow.body_force - flow.density * acceleration_at_wall(flow.velocity[P], boundary.values(), b, slips || has_wall_function), out);
      if (around) slope = std::lerp(slope, *around, share);
      slope += dot(given, out);
      given_[b] = slope - wall_slope[b];
      wall_slope[b] = slope;
    }
  }
}

void Continuity::balance_reaction(Flow& flow) {
  const bool any = std::any_of(flow.reaction.begin(), flow.reaction.end(), [](const Vec3& force) { return force != Vec3{}; });
  reaction_.clear(), reaction_excess_.clear();
  reaction_is_new_ = true;
  if (sum(mesh_.comm, std::int64_t{any}) == 0) return;
  reaction_ = flow.reaction;
  reaction_.resize(static_cast<std::size_t>(mesh_.n_all_cells()));
  mesh_.halo.exchange(reaction_);
  for (int f = 0; f < mesh_.n_interior; ++f)
    change_[f] = 0.5 * dot(reaction_[mesh_.owner[f]] + reaction_[mesh_.neighbour[f]], mesh_.delta[f]);
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const Vec3& force = reaction_[mesh_.owner[f]];
      change_[f] = dot(force, squares_.side(p) == Side::value ? mesh_.delta[f] : unit(mesh_.face_vector[f]));
    }
  find_held_by_pressure();
  const std::vector<Vec3>& held = gradient_;
  std::copy_n(held.begin(), mesh_.n_cells, flow.reaction.begin());
  reaction_excess_.resize(static_cast<std::size_t>(mesh_.n_interior));
  for (int f = 0; f < mesh_.n_interior; ++f) {
    const Vec3 at_face = blend(mesh_.weight[f], held[mesh_.owner[f]], held[mesh_.neighbour[f]]);
    reaction_excess_[f] = coefficient_[f] * (change_[f] - dot(at_face, mesh_.delta[f]));
  }
  set_mean_flux(held);
  for (std::size_t i = 0; i < closed_faces_.size(); ++i) reaction_excess_[closed_faces_[i]] += mean_flux_[i];
}

/// f~ of the header in all cells, into gradient_: with the sum of f.
void Continuity::find_held_by_pressure() {
  std::vector<Vec3>& held = gradient_;
  squares_.gradient_of_changes(change_, slope_);
  gauss_gradient_of_changes(mesh_, squares_, change_, boundary_correction_, slope_, held);
  std::array<RunningSum, 4> parts;  // of (f~ - f) V, N, and of |f| V
  for (int c = 0; c < mesh_.n_cells; ++c) {
    const Vec3 more = mesh_.cell_volume[c] * (held[c] - reaction_[c]);
    if (more == Vec3{} && reaction_[c] == Vec3{}) continue;
    for (int i = 0; i < 3; ++i) parts[static_cast<std::size_t>(i)].add(more[i]);
    parts[3].add(mesh_.cell_volume[c] * norm(reaction_[c]));
  }
  const std::vector<double> total = sums(mesh_.comm, parts);
  const Vec3 too_much = Vec3{total[0], total[1], total[2]} / total[3];
  for (int c = 0; c < mesh_.n_cells; ++c) held[c] -= norm(reaction_[c]) * too_much;
  mesh_.halo.exchange(held);
}

void Continuity::predict_flux(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient, Purpose purpose) {
  const bool with_pressure = purpose != Purpose::projection, for_history = purpose != Purpose::correction;
  const auto& u = flow.velocity;
  const auto& g = flow.pressure_gradient;
  // [g]_f.S - c (p_N - p_P) - T.[g]_f: what remains is c times the difference of the two along d
  const auto damping = [&](int f) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    const double w = mesh_.weight[f];
    double difference = coefficient_[f] * (dot(blend(w, g[P], g[N]), mesh_.delta[f]) - (flow.pressure[N] - flow.pressure[P]));
    if (!reaction_excess_.empty()) difference += reaction_excess_[f];
    return mobility_ * difference;
  };
  mean_gradient_.set(mesh_, gradient);
  for (int f = 0; f < mesh_.n_interior; ++f) {
    const Vec3 u_f = blend(mesh_.weight[f], u[mesh_.owner[f]], u[mesh_.neighbour[f]]);
    const double psi = with_pressure ? history.pressure_share()[f] * damping(f) + history.inherited()[f] : 0;
    flow.flux[f] = interpolated_flux(mesh_, f, u_f, mean_gradient_) + psi;
    if (for_history) history.take(f, psi);
  }
  if (with_pressure) {
    set_mean_flux(g);
    for (std::size_t i = 0; i < closed_faces_.size(); ++i) {
      const int f = closed_faces_[i];
      const double less = history.pressure_share()[f] * mobility_ * mean_flux_[i];
      flow.flux[f] -= less;
      if (for_history) history.add(f, -less);
    }
  }
  boundary_flux(flow, boundary, gradient, purpose);
}

void Continuity::boundary_flux(Flow& flow, const BoundarySet& boundary, const std::vector<Mat3>& gradient, Purpose purpose) {
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    const FaceFlux source = boundary.flux(static_cast<int>(p));
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const int P = mesh_.owner[f], b = f - mesh_.n_interior;
      double psi = 0;
      if (source == FaceFlux::given) {
        flow.flux[f] = boundary.values().flux[b];
      } else if (source == FaceFlux::tight) {
        flow.flux[f] = flow.mesh_flux[f];
      } else {
        const Vec3 &d = mesh_.delta[f], &g = flow.pressure_gradient[P];
        // S.g - [c (p_b - p_P) + T.g] = c (d.g - (p_b - p_P))
        if (purpose != Purpose::projection)
          psi = history.pressure_share()[f] * mobility_ * coefficient_[f] * (dot(d, g) - (flow.boundary_pressure[b] - flow.pressure[P])) +
                history.inherited()[f];
        flow.flux[f] = leaving_flux(mesh_, f, flow.velocity[P], gradient[P]) + psi;
      }
      if (purpose != Purpose::correction) history.take(f, psi);
    }
  }
}

/// Keeps psi for the next step: psi of the predicted flux, and m D of p' with the last grad p'. Across oblique faces the last solve used
/// the grad p' before. If psi kept the difference of the two, it would add up from step to step, an error of first order in the step.
void Continuity::carry_history() {
  for (int f = 0; f < mesh_.n_interior; ++f) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    const double change = dot(blend(mesh_.weight[f], gradient_[P], gradient_[N]), mesh_.delta[f]) - (correction_[N] - correction_[P]);
    history.add(f, mobility_ * coefficient_[f] * change);
  }
  set_mean_flux(gradient_);
  for (std::size_t i = 0; i < closed_faces_.size(); ++i) history.add(closed_faces_[i], -mobility_ * mean_flux_[i]);
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) {
    const int P = mesh_.owner[f];
    const double change = dot(gradient_[P], mesh_.delta[f]) - (given_[f - mesh_.n_interior] - correction_[P]);
    history.add(f, mobility_ * coefficient_[f] * change);  // c is 0 where the flux is given
  }
  history.end_step();
}

/// T.[g^ - g]_f of closed_faces_.
void Continuity::set_mean_flux(const std::vector<Vec3>& g) {
  if (is_closed_.empty()) return;
  for (const int c : closed_cells_) to_mean_[c] = mean_of_neighbours(mesh_, c, g) - g[c];
  mesh_.halo.exchange(to_mean_);
  for (std::size_t i = 0; i < closed_faces_.size(); ++i) {
    const int f = closed_faces_[i];
    mean_flux_[i] = dot(cross_vector(f), blend(mesh_.weight[f], to_mean_[mesh_.owner[f]], to_mean_[mesh_.neighbour[f]]));
  }
}

/// From face `first` on.
void Continuity::find_closed_faces(int first) {
  if (is_closed_.empty()) return;
  std::erase_if(closed_faces_, [first](int f) { return f >= first; });
  for (int f = first; f < mesh_.n_interior; ++f)
    if (is_closed_[mesh_.owner[f]] || is_closed_[mesh_.neighbour[f]]) closed_faces_.push_back(f);
  mean_flux_.resize(closed_faces_.size());
}

/// From face `first` on: turning does not change the others.
void Continuity::set_coefficients(const BoundarySet& boundary, int first) {
  resize_with_room(coefficient_, static_cast<std::size_t>(mesh_.n_faces));
  for (int f = first; f < mesh_.n_interior; ++f) coefficient_[f] = conductance(mesh_.face_vector[f], mesh_.delta[f]);
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    const bool fixed = boundary.pressure_side(static_cast<int>(p)) == Side::value;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f)
      coefficient_[f] = fixed ? conductance(mesh_.face_vector[f], mesh_.delta[f]) : 0;
  }
  poisson_.set_coefficients(coefficient_);
  find_closed_faces(first);
}

/// Fills imbalance_; p' begins at zero.
Continuity::Imbalance Continuity::begin_correction(const std::vector<double>& flux, const BoundaryValues& values) {
  std::fill(correction_.begin(), correction_.end(), 0.0);
  std::fill(imbalance_.begin(), imbalance_.end(), 0.0);
  double squares[2];
  for (int f = 0; f < mesh_.n_interior; ++f) {
    imbalance_[mesh_.owner[f]] += flux[f];
    imbalance_[mesh_.neighbour[f]] -= flux[f];
  }
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) imbalance_[mesh_.owner[f]] += flux[f];
  squares[0] = sum_of_squares(imbalance_.data(), mesh_.n_cells), squares[1] = sum_of_squares(flux.data(), mesh_.n_faces);
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f)
    squares[1] += norm_squared(values.velocity[f - mesh_.n_interior]) * norm_squared(mesh_.face_vector[f]);
  MPI_Allreduce(MPI_IN_PLACE, squares, 2, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  return {.norm = std::sqrt(squares[0]), .rounding = rounding * std::sqrt(squares[1])};
}

ContinuityReport Continuity::solve(Flow& flow, const BoundaryValues& values, int n_non_orthogonal_correctors) {
  const Imbalance imbalance = begin_correction(flow.flux, values);
  ContinuityReport report{.initial = imbalance.norm};
  for (int k = 0; k <= n_non_orthogonal_correctors; ++k) {
    set_right_side();
    if (k > 0) {
      squares_.gradient(correction_, given_, slope_);
      fill_boundary(mesh_, squares_, correction_, slope_, given_, boundary_correction_);
      gauss_gradient(mesh_, squares_, correction_, boundary_correction_, slope_, gradient_);
      set_mean_flux(gradient_);
      add_cross_flux();
    }
    const double tolerance = k == n_non_orthogonal_correctors ? settings_.tolerance : settings_.tolerance_intermediate;
    const PoissonReport last =
        poisson_.solve(right_side_, correction_, std::max(tolerance * report.initial, imbalance.rounding) / mobility_);
    report.iterations += last.iterations, ++report.solves;
    report.rebuilt = report.rebuilt || last.rebuilt;
    report.final = last.final * mobility_;
  }
  if (report.rebuilt) note_preconditioner(flow);
  correct_flux(flow.flux, n_non_orthogonal_correctors > 0);
  return report;
}

void Continuity::note_preconditioner(const Flow& flow) {
  if (flow.rotating_zone) preconditioner_angle_ = flow.rotating_zone->mesh().angle();
}

void Continuity::close(std::vector<double>& flux, const Flow& flow, const BoundarySet& boundary, const TimeScheme& time) {
  mobility_ = time.dt / (time.now * flow.density);
  const Imbalance imbalance = begin_correction(flux, boundary.values());
  std::fill(given_.begin(), given_.end(), 0.0);
  set_right_side();
  const PoissonReport report =
      poisson_.solve(right_side_, correction_, std::max(settings_.tolerance_intermediate * imbalance.norm, imbalance.rounding) / mobility_);
  if (report.rebuilt) note_preconditioner(flow);
  correct_flux(flux, false);
}

/// Right side of the pressure equation, - imbalance/m, with what is given at the boundary.
void Continuity::set_right_side() {
  for (int c = 0; c < mesh_.n_cells; ++c) right_side_[c] = -imbalance_[c] / mobility_;
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) right_side_[mesh_.owner[f]] += coefficient_[f] * given_[f - mesh_.n_interior];
}

/// What the last gradient of p' carries across non-orthogonal faces, to the right side.
void Continuity::add_cross_flux() {
  for (int f = 0; f < mesh_.n_interior; ++f) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    const double cross = dot(cross_vector(f), blend(mesh_.weight[f], gradient_[P], gradient_[N]));
    right_side_[P] += cross;
    right_side_[N] -= cross;
  }
  for (std::size_t i = 0; i < closed_faces_.size(); ++i) {
    right_side_[mesh_.owner[closed_faces_[i]]] += mean_flux_[i];
    right_side_[mesh_.neighbour[closed_faces_[i]]] -= mean_flux_[i];
  }
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f)
    if (coefficient_[f] != 0) right_side_[mesh_.owner[f]] += dot(cross_vector(f), gradient_[mesh_.owner[f]]);
}

/// flux -= m (c (p'_N - p'_P) + T.grad p'), with the grad p' of the last right side; without one it had none.
void Continuity::correct_flux(std::vector<double>& flux, bool with_gradient) {
  for (int f = 0; f < mesh_.n_interior; ++f) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    double across = coefficient_[f] * (correction_[N] - correction_[P]);
    if (with_gradient) across += dot(cross_vector(f), blend(mesh_.weight[f], gradient_[P], gradient_[N]));
    flux[f] -= mobility_ * across;
  }
  if (with_gradient)
    for (std::size_t i = 0; i < closed_faces_.size(); ++i) flux[closed_faces_[i]] -= mobility_ * mean_flux_[i];
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) {
    if (coefficient_[f] == 0) continue;
    const int P = mesh_.owner[f];
    double across = coefficient_[f] * (given_[f - mesh_.n_interior] - correction_[P]);
    if (with_gradient) across += dot(cross_vector(f), gradient_[P]);
    flux[f] -= mobility_ * across;
  }
}

void Continuity::correct_cells(Flow& flow, bool with_pressure) {
  squares_.gradient(correction_, given_, slope_);
  fill_boundary(mesh_, squares_, correction_, slope_, given_, boundary_correction_);
  facet_correction_.resize(static_cast<std::size_t>(mesh_.n_interior - mesh_.first_facet));
  gauss_gradient(mesh_, squares_, correction_, boundary_correction_, slope_, gradient_, facet_correction_);
  for (int c = 0; c < mesh_.n_all_cells(); ++c) flow.velocity[c] -= mobility_ * gradient_[c];
  if (!with_pressure) return;
  facet_pressure_.resize(facet_correction_.size());  // a resumed run without balances has none
  for (std::size_t i = 0; i < facet_correction_.size(); ++i) facet_pressure_[i] += facet_correction_[i];
  for (int c = 0; c < mesh_.n_all_cells(); ++c) flow.pressure[c] += correction_[c], flow.pressure_gradient[c] += gradient_[c];
  for (std::size_t b = 0; b < boundary_correction_.size(); ++b) flow.boundary_pressure[b] += boundary_correction_[b];
}

void Continuity::restore(double preconditioner_angle, const BoundarySet& boundary, double fresh_cost, bool rebuild_due) {
  preconditioner_angle_ = preconditioner_angle;
  set_coefficients(boundary, mesh_.first_facet);
  poisson_.restore(fresh_cost, rebuild_due);
}

}  // namespace snag
