// The sums; the equations stand in the header.
#include "solver/balances.hpp"

#include <algorithm>
#include <span>
#include <tuple>

#include "solver/convection/convection.hpp"
#include "solver/fields/face.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace {

constexpr int block = 512;  // faces whose fluxes are held at a time

void keep(const std::vector<Vec3>& u, std::vector<SingleVec3>& kept) {
  kept.resize(u.size());
  std::ranges::transform(u, kept.begin(), [](const Vec3& a) { return single(a); });
}

void keep(const std::vector<Vec3>& u, const std::vector<Vec3>& less, std::vector<SingleVec3>& kept) {
  kept.resize(u.size());
  std::ranges::transform(u, less, kept.begin(), [](const Vec3& a, const Vec3& b) { return single(a - b); });
}

void recall(const std::vector<SingleVec3>& kept, const std::vector<Vec3>& plus, std::vector<Vec3>& u) {
  std::ranges::transform(kept, plus, u.begin(), [](const SingleVec3& a, const Vec3& b) { return wide(a) + b; });
}

}  // namespace

double AngularMomentumBalance::walls() const {
  double total = 0;
  for (std::size_t p = 0; p < wall_pressure.size(); ++p) total += wall_pressure[p] + wall_friction[p];
  return total;
}

struct Balances::Step {
  const Momentum& momentum;
  const Flow& flow;
  const BoundarySet& boundary;
  const TimeScheme& time;
  const std::vector<double>& facet_pressure;
  Mat3 to_old, to_older;    // turn what turns back to where it was a step and two steps ago
  Mat3 turning_difference;  // of a sliding zone
  Vec3 coriolis;            // omega of a frame, rad/s

  Step(const Momentum& momentum_of_step, const Flow& flow_of_step, const BoundarySet& conditions, const TimeScheme& scheme,
       const std::vector<double>& at_facets, const Vec3& axis)
      : momentum(momentum_of_step), flow(flow_of_step), boundary(conditions), time(scheme), facet_pressure(at_facets) {
    const RotatingZone* zone = flow.rotating_zone;
    const double now = flow.time + time.dt;
    const auto turned = [&](double then) { return zone ? zone->angle(then) - zone->angle(now) : 0.0; };
    to_old = rotation(axis, turned(flow.time));
    to_older = rotation(axis, time.ratio > 0 ? turned(flow.time - time.dt / time.ratio) : 0.0);
    if (zone) turning_difference = zone->turning_difference(flow.time, time);
    if (zone && !zone->slides()) coriolis = zone->rotation_speed(now);
  }

  /// Of mu_eff at a face, the share of mu.
  double viscous_share(int f) const { return flow.face_viscosity[f] > 0 ? flow.dynamic_viscosity / flow.face_viscosity[f] : 1; }
  /// mu grad u^T S, the part of the stress that the equation omits where mu is constant, N.
  Vec3 omitted_stress(int f, const Mat3& G) const { return flow.face_viscosity[f] * transposed_product(G, flow.mesh.face_vector[f]); }
};

Balances::Balances(const Mesh& mesh, const Vec3& origin, const Vec3& axis, int turning, Workspace& workspace)
    : mesh_(mesh),
      origin_(origin),
      axis_(unit(axis)),
      turning_zone_(turning),
      guess_(workspace.vector[0]),
      predicted_(workspace.vector[1]) {
  for (auto& faces : has_faces_) faces.assign(mesh.patches.size(), 0);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) has_faces_[zone_of(mesh.owner[f])][p] = 1;
  for (int c = 0; c < mesh.n_cells; ++c) has_cells_[zone_of(c)] = 1;
  for (auto& faces : has_faces_) MPI_Allreduce(MPI_IN_PLACE, faces.data(), static_cast<int>(faces.size()), MPI_INT, MPI_MAX, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, has_cells_.data(), 2, MPI_INT, MPI_MAX, mesh.comm);
}

void Balances::take_guess(const Flow& flow) { keep(flow.velocity, flow.velocity_old, kept_guess_); }

void Balances::take_limiter(Momentum& momentum) { keep(momentum.limiter_factors(), kept_factors_); }

void Balances::close(Momentum& momentum, const Flow& flow, const BoundarySet& boundary, const TimeScheme& time,
                     const Continuity& continuity) {
  for (AngularMomentumBalance& zone : zone_) {
    zone = {};
    zone.wall_pressure.assign(mesh_.patches.size(), 0), zone.wall_friction.assign(mesh_.patches.size(), 0);
  }
  energy_ = {}, shaft_torque_ = 0;
  recall(kept_guess_, flow.velocity_old, guess_);
  // What the correction took off; its gradient may stand in the place of the prediction.
  const double mobility = time.dt / (time.now * flow.density);
  std::ranges::transform(flow.velocity, continuity.correction_gradient(), predicted_.begin(),
                         [mobility](const Vec3& u, const Vec3& gradient) { return u + mobility * gradient; });
  std::ranges::transform(kept_factors_, momentum.limiter_factors().begin(), [](const SingleVec3& of_cell) { return wide(of_cell); });
  const Step step(momentum, flow, boundary, time, continuity.facet_pressure(), axis_);
  add_cells(step);
  add_inner_faces(step);
  add_boundary(step);
  sum_over_ranks();
}

void Balances::add_cells(const Step& step) {
  const Flow& flow = step.flow;
  const double dt = step.time.dt, a0 = step.time.now, a1 = step.time.old, a2 = step.time.older;
  for (int c = 0; c < mesh_.n_cells; ++c) {
    const int z = zone_of(c);
    AngularMomentumBalance& zone = zone_[z];
    const double V = mesh_.cell_volume[c], inertia = flow.density * V / dt;
    const Vec3 r = mesh_.cell_centre[c] - origin_;
    const Vec3 &u = flow.velocity[c], &u_old = flow.velocity_old[c], &u_older = flow.velocity_older[c];
    Vec3 change = inertia * (a0 * u + a1 * u_old + a2 * u_older);
    if (z == 0) change += inertia * (step.turning_difference * second_difference(step.time, guess_[c], u_old, u_older));

    const Vec3 r_old = z == 0 ? step.to_old * r : r, r_older = z == 0 ? step.to_older * r : r;
    const double stored = inertia * (a0 * torque(r, u) + a1 * torque(r_old, u_old) + a2 * torque(r_older, u_older));
    zone.stored += stored;
    zone.lost_convection += torque(r, change) - stored;
    zone.lost_pressure += torque(r, V * flow.pressure_gradient[c]);
    const Vec3 given = V * ((flow.reaction.empty() ? Vec3{} : flow.reaction[c]) + flow.body_force);
    zone.given += torque(r, given);

    const double energy = 0.5 * inertia * (a0 * norm_squared(u) + a1 * norm_squared(u_old) + a2 * norm_squared(u_older));
    energy_.stored += energy;
    energy_.numerical_time += dot(u, change) - energy;
    energy_.numerical_pressure += V * dot(u, flow.pressure_gradient[c]);
    energy_.given += dot(u, given);
    if (z == 0 && norm_squared(step.coriolis) > 0) {
      const Vec3 force = flow.density * V * cross(step.coriolis, guess_[c]);
      zone.lost_convection += torque(r, force);
      energy_.numerical_convection += dot(u, force);
    }
  }
}

/// `lost` of both cells of a face with flux M, N: - s (r_f - r_c) x M, in sum - d x M.
void Balances::add_inner_faces(const Step& step) {
  const Flow& flow = step.flow;
  const std::vector<Mat3>& G = flow.velocity_gradient;
  std::array<MomentumFlux, block> flux;
  for (int first = 0; first < mesh_.n_interior; first += block) {
    const int n = std::min(block, mesh_.n_interior - first);
    step.momentum.fluxes(flow, guess_, predicted_, first, std::span(flux).first(static_cast<std::size_t>(n)));
    for (int i = 0; i < n; ++i) {
      const int f = first + i, P = mesh_.owner[f], N = mesh_.neighbour[f];
      const auto& [carried, rubbed] = flux[i];
      const Vec3& d = mesh_.delta[f];
      Vec3 omitted;
      if (!flow.variable_viscosity) omitted = -step.omitted_stress(f, blend(mesh_.weight[f], G[P], G[N]));
      const bool is_facet = f >= mesh_.first_facet && zone_of(P) != zone_of(N);
      const bool has_P = P < mesh_.n_cells, has_N = N < mesh_.n_cells;
      if (has_P && has_N && !is_facet) {
        AngularMomentumBalance& zone = zone_[zone_of(P)];
        zone.lost_convection -= torque(d, carried);
        zone.lost_friction -= torque(d, rubbed);
        add_energy(step, f, flow.velocity[P] - flow.velocity[N], flux[i], omitted);
        continue;
      }
      const Vec3 way = mesh_.face_centre[f] - mesh_.cell_centre[P], r = mesh_.face_centre[f] - origin_;
      for (const auto& [c, s, from_centre] : {std::tuple(P, 1.0, way), std::tuple(N, -1.0, way - d)}) {
        if (c >= mesh_.n_cells) continue;
        AngularMomentumBalance& zone = zone_[zone_of(c)];
        zone.lost_convection -= s * torque(from_centre, carried);
        zone.lost_friction -= s * torque(from_centre, rubbed);
        if (is_facet) {
          const Vec3 push = step.facet_pressure[static_cast<std::size_t>(f - mesh_.first_facet)] * mesh_.face_vector[f];
          zone.interface += s * torque(r, carried + rubbed + omitted + push);
          zone.lost_friction -= s * torque(r, omitted);
          zone.lost_pressure -= s * torque(r, push);
        }
        add_energy(step, f, s * flow.velocity[c], flux[i], omitted);
      }
    }
  }
}

/// Of inner face f, where `difference` is u_P - u_N, or what this rank has of it.
void Balances::add_energy(const Step& step, int f, const Vec3& difference, const MomentumFlux& flux, const Vec3& omitted) {
  energy_.numerical_convection += dot(difference, flux.convection);
  const double viscous = step.viscous_share(f), dissipated = dot(difference, flux.friction + omitted);
  energy_.dissipation_viscous += viscous * dissipated, energy_.dissipation_turbulent += (1 - viscous) * dissipated;
  energy_.numerical_friction -= dot(difference, omitted);
}

void Balances::add_boundary(const Step& step) {
  const Flow& flow = step.flow;
  const std::vector<Mat3>& G = flow.velocity_gradient;
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    const int patch = static_cast<int>(p);
    const bool is_open = step.boundary.is_open(patch), is_wall = step.boundary.is_wall(patch);
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const int P = mesh_.owner[f], b = f - mesh_.n_interior;
      const Vec3 &S = mesh_.face_vector[f], &u = flow.velocity[P], &d = mesh_.delta[f];
      const Vec3 r = mesh_.face_centre[f] - origin_;
      const Vec3 push = flow.boundary_pressure[b] * S, &rubbed = flow.boundary_friction[b], &carried = flow.boundary_convection[b];
      Vec3 omitted;
      if (!flow.variable_viscosity) omitted = is_wall ? flow.turning_friction[b] : is_open ? -step.omitted_stress(f, G[P]) : rubbed;
      AngularMomentumBalance& zone = zone_[zone_of(P)];
      zone.lost_convection -= torque(d, carried);
      zone.lost_friction -= torque(d, rubbed) + torque(r, omitted);
      zone.lost_pressure -= torque(r, push);
      const double pressure = torque(r, push), friction = torque(r, rubbed + omitted);
      if (is_open) {
        zone.openings += torque(r, carried) + pressure + friction;
      } else {
        zone.wall_pressure[p] += pressure, zone.wall_friction[p] += friction;
        if (norm_squared(step.boundary.values().spin[b]) > 0) shaft_torque_ -= pressure + friction;
      }

      const double F = flow.density * step.momentum.convecting_flux()[f];  // kg/s
      const double kinetic = is_open && F != 0 ? 0.5 * norm_squared(carried) / F : 0;
      const Vec3 n = S / norm(S);
      const bool given = step.boundary.velocity_side(patch) == Side::value;
      // The velocity at the face: as given, as it is carried, or that of the cell along the plane with the normal part of the plane.
      const Vec3& u_w = step.boundary.values().velocity[b];
      const Vec3 u_b = given ? u_w : is_open ? (F != 0 ? carried / F : u) : u - dot(u - u_w, n) * n;
      const double done = dot(u_b, rubbed + omitted), dissipated = dot(u - u_b, rubbed + omitted);
      const double push_power = is_wall ? dot(u_b, push) : flow.boundary_pressure[b] * flow.flux[f];
      energy_.numerical_convection += dot(u, carried) - kinetic;
      energy_.numerical_pressure -= push_power;
      energy_.numerical_friction -= dot(u, omitted);
      if (is_open)
        energy_.hydraulic += kinetic + push_power + done;
      else
        energy_.shaft -= push_power + done;
      if (is_wall) {
        energy_.dissipation_walls += dissipated;
      } else {
        const double viscous = step.viscous_share(f);
        energy_.dissipation_viscous += viscous * dissipated, energy_.dissipation_turbulent += (1 - viscous) * dissipated;
      }
    }
  }
}

void Balances::sum_over_ranks() {
  std::vector<double*> terms{&shaft_torque_,
                             &energy_.shaft,
                             &energy_.given,
                             &energy_.hydraulic,
                             &energy_.stored,
                             &energy_.dissipation_viscous,
                             &energy_.dissipation_turbulent,
                             &energy_.dissipation_walls,
                             &energy_.numerical_convection,
                             &energy_.numerical_time,
                             &energy_.numerical_pressure,
                             &energy_.numerical_friction};
  for (AngularMomentumBalance& zone : zone_) {
    for (double* term :
         {&zone.stored, &zone.openings, &zone.interface, &zone.given, &zone.lost_convection, &zone.lost_pressure, &zone.lost_friction})
      terms.push_back(term);
    for (double& term : zone.wall_pressure) terms.push_back(&term);
    for (double& term : zone.wall_friction) terms.push_back(&term);
  }
  std::vector<double> values;
  values.reserve(terms.size());
  for (const double* term : terms) values.push_back(*term);
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, mesh_.comm);
  for (std::size_t i = 0; i < terms.size(); ++i) *terms[i] = values[i];
}

}  // namespace snag
