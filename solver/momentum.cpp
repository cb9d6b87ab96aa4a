// Assembly and solution of the momentum equation, one row a cell, common to the three components but for its 3 x 3 block at symmetry
// planes.
//
//   convection   F u_f = F u_C + F (u_f^high - u_C)        C: upwind cell; first part implicit, second explicit from the guess, by a scheme
//                                                          (solver/convection/schemes/)
//   diffusion    mu (c (u_N - u_P) + G_f T [+ G_f^T S where mu varies])     first part implicit
//
// Where mu varies, the faces of a corner cell (mesh/skewness.hpp) have the implicit part alone. Least squares take the gradient of such a
// cell mainly from wall values, and assume a linear profile, which a wall function is not. With the explicit parts, single cells at the
// edge of a vane reached six times the speed of the vane.
//
// Where mu is constant, div(mu grad u^T) is zero and the equation omits it. The force on a turning wall has this part of the stress all
// the same: (grad u^T S)_i = S_j du_j/dx_i = (S x omega)_i, because u = omega x r on the wall and du_n/dn = 0. Flow::turning_friction
// holds it, mu omega x S, the force of the fluid on the wall; only the forces on patches use it.
//
// Explicit parts from u extrapolated fully in time are unstable at large steps (von Neumann analysis of BDF2 with Fromm's scheme:
// amplification up to 1.2 above Courant 0.5, none for half the extrapolation). So cells take a share e of the extrapolation: 1 below
// Courant 0.5, 1/2 above 1.5, and less where diffusion is fast. The error of a share is O(h dt), of second order where the Courant number
// is above 1/2.
//
// Fluxes F extrapolated fully in time are unstable in strong shear at large steps: u' across the shear changes F, which carries the shear
// along with twice the weight. They take one share, the same on all faces, so that they stay free of divergence, from the largest
// s = |G| / (a0/dt + rates of convection and diffusion) of all cells: 1 to s = 1/2, none above 1. The error of a share is O(dt): with one
// corrector steps in strong shear are of second order up to s = 1/2; more correctors replace the guess.
#include "solver/momentum.hpp"

#include <algorithm>

#include "mesh/geometry.hpp"
#include "mesh/skewness.hpp"
#include "parallel/sum.hpp"
#include "solver/convection/convection.hpp"
#include "solver/convection/limiter.hpp"
#include "solver/fields/face.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace {

// Share of the extrapolation of the fluxes: full up to the first shear number, none above the second. Behind a backward-facing step the
// reattachment wanders where s is 1 and fluxes are extrapolated, and rests where s is 0.8.
constexpr double shear_full = 0.5, shear_none = 1;

/// Share e of the extrapolation in time, from Courant number and diffusion number of a cell.
inline double extrapolation_share(double courant, double diffusion) {
  return std::min(std::clamp(1.25 - 0.5 * courant, 0.5, 1.0), std::clamp(1.25 - 0.5 * diffusion, 0.0, 1.0));
}

/// The zone whose faces turn, -1: none.
int sliding_zone(const Flow& flow) { return flow.rotating_zone && flow.rotating_zone->slides() ? flow.rotating_zone->zone() : -1; }

}  // namespace

TimeScheme bdf(double dt, double dt_old) {
  if (dt_old <= 0) return {.dt = dt};
  const double r = dt / dt_old;
  return {.dt = dt, .now = (1 + 2 * r) / (1 + r), .old = -(1 + r), .older = r * r / (1 + r), .ratio = r};
}

Momentum::Momentum(const Mesh& mesh, const MomentumSettings& settings, Workspace& workspace)
    : mesh_(mesh),
      settings_(settings),
      scheme_(convection_schemes().make(settings.convection, "[flow] convection")),
      limiter_(limiters().make(settings.limiter, "[flow] limiter")),
      matrix_(workspace.matrix),
      diagonal_(workspace.vector[0]),
      right_side_(workspace.vector[1]),
      psi_(workspace.vector[2]),
      mean_gradient_(workspace.mean_gradient()),
      reconstruction_(mesh),
      convection_rate_(workspace.scalar_in(workspace.vector[0], 0)),
      diffusion_rate_(workspace.scalar_in(workspace.vector[0], 1)),
      flux_(workspace.face) {
  std::vector<double> corner(static_cast<std::size_t>(mesh.n_all_cells()));
  for (const int c : corner_cells(mesh)) corner[c] = 1;
  mesh.halo.exchange(corner);
  in_corner_.assign(corner.begin(), corner.end());
  for (int f = 0; f < mesh.first_facet; ++f) has_periods_ = has_periods_ || norm_squared(period(mesh, f)) > 0;
}

/// Fluxes as they were. Those that stand are taken as they are: free of divergence. Where faces turn, u and psi are, so that the flux is
/// that of the face as it lies now; facets have no psi.
void Momentum::guess_flux(const Flow& flow, const FluxHistory& history) {
  const auto& u = flow.velocity_old;
  const int turning = sliding_zone(flow);
  if (flow.rotating_zone) mean_gradient_.set_where_faces_turn(mesh_, flow.velocity_gradient, turning);
  const auto of_cells = [&](int f) {
    return interpolated_flux(mesh_, f, blend(mesh_.weight[f], u[mesh_.owner[f]], u[mesh_.neighbour[f]]), mean_gradient_);
  };
  for (int f = 0; f < mesh_.first_facet; ++f)
    flux_[f] = (mesh_.cell_zone[mesh_.owner[f]] == turning ? of_cells(f) + history.deviation[f] : flow.flux_old[f]) - flow.mesh_flux[f];
  for (int f = mesh_.first_facet; f < mesh_.n_interior; ++f) flux_[f] = of_cells(f);
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) flux_[f] = flow.flux_old[f] - flow.mesh_flux[f];
}

/// Adds a share of what the last step changed; of the gradients that count for skewness it does not.
void Momentum::extrapolate_flux(const Flow& flow, const FluxHistory& history, double share) {
  const auto &u = flow.velocity_old, &before = flow.velocity_older;
  const int turning = sliding_zone(flow);
  const auto change_of_cells = [&](int f) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    return dot(blend(mesh_.weight[f], u[P] - before[P], u[N] - before[N]), mesh_.face_vector[f]);
  };
  // flow.flux holds flux^(n-1) until it is corrected
  const auto change = [&](int f) { return flow.flux_old[f] - flow.flux[f]; };
  for (int f = 0; f < mesh_.first_facet; ++f)
    flux_[f] += share * (mesh_.cell_zone[mesh_.owner[f]] == turning ? change_of_cells(f) + (history.deviation[f] - history.deviation_old[f])
                                                                    : change(f));
  for (int f = mesh_.first_facet; f < mesh_.n_interior; ++f) flux_[f] += share * change_of_cells(f);
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) flux_[f] += share * change(f);
}

double Momentum::guess_from_history(Flow& flow, const FluxHistory& history, const TimeScheme& time) {
  const double r = time.ratio;
  guess_flux(flow, history);
  set_convection_rate(), set_diffusion_rate(flow);
  const double share = flux_share(flow, time);
  if (share > 0) {
    extrapolate_flux(flow, history, r * share);
    set_convection_rate();
  }
  mesh_.halo.exchange(convection_rate_), mesh_.halo.exchange(diffusion_rate_);
  for (int c = 0; c < mesh_.n_all_cells(); ++c) {
    const double dt_over_V = time.dt / mesh_.cell_volume[c];
    const double e = r * extrapolation_share(dt_over_V * convection_rate_[c], dt_over_V * diffusion_rate_[c]);
    const Mat3& G = flow.velocity_gradient[c];
    Mat3& guess = flow.velocity_gradient_old[c];
    for (int i = 0; i < 3; ++i) guess[i] = (1 + e) * G[i] - e * guess[i];
    flow.velocity[c] = (1 + r) * flow.velocity_old[c] - r * flow.velocity_older[c];
  }
  std::swap(flow.velocity_gradient, flow.velocity_gradient_old);
  return share;
}

/// Of the owned cells, from flux_.
void Momentum::set_convection_rate() {
  const auto rate = convection_rate_;
  std::fill(rate.begin(), rate.end(), 0.0);
  for (int f = 0; f < mesh_.n_interior; ++f) {
    rate[mesh_.owner[f]] += std::max(flux_[f], 0.0);
    rate[mesh_.neighbour[f]] += std::max(-flux_[f], 0.0);
  }
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) rate[mesh_.owner[f]] += std::max(flux_[f], 0.0);
}

/// Of the owned cells, from the viscosity.
void Momentum::set_diffusion_rate(const Flow& flow) {
  const auto rate = diffusion_rate_;
  std::fill(rate.begin(), rate.end(), 0.0);
  for (int f = 0; f < mesh_.n_faces; ++f) {
    const double c = conductance(mesh_.face_vector[f], mesh_.delta[f]) * flow.face_viscosity[f] / flow.density;
    rate[mesh_.owner[f]] += c;
    if (f < mesh_.n_interior) rate[mesh_.neighbour[f]] += c;
  }
}

/// Share of the extrapolation of the fluxes, from the velocity gradient and the rates of the last step; the same on every rank.
double Momentum::flux_share(const Flow& flow, const TimeScheme& time) const {
  double shear = 0;
  for (int c = 0; c < mesh_.n_cells; ++c) {
    const Mat3& G = flow.velocity_gradient[c];
    const double rate = time.now / time.dt + (convection_rate_[c] + diffusion_rate_[c]) / mesh_.cell_volume[c];
    shear = std::max(shear, std::sqrt(norm_squared(G[0]) + norm_squared(G[1]) + norm_squared(G[2])) / rate);
  }
  return std::clamp((shear_none - maximum(mesh_.comm, shear)) / (shear_none - shear_full), 0.0, 1.0);
}

void Momentum::guess_from_last(const Flow& flow) {
  for (int f = 0; f < mesh_.n_faces; ++f) flux_[f] = flow.flux[f] - flow.mesh_flux[f];
}

void Momentum::limit(const Flow& flow, const BoundarySet& boundary) {
  convected_ = scheme_->is_limited() ? &reconstruction_.gradient(flow.velocity_gradient) : &flow.velocity_gradient;
  if (!scheme_->is_limited()) return;
  double speed2 = 0;
  for (int c = 0; c < mesh_.n_cells; ++c) speed2 = std::max(speed2, norm_squared(flow.velocity[c]));
  limiter_->limit({.mesh = mesh_,
                   .has_periods = has_periods_,
                   .u = flow.velocity,
                   .G = *convected_,
                   .reference_speed = std::sqrt(maximum(mesh_.comm, speed2)),
                   .ranges = reconstruction_.ranges(flow.velocity, boundary.velocity_sides(), boundary.values().velocity)},
                  psi_);
}

SweepReport Momentum::predict(Flow& flow, const BoundarySet& boundary, const TimeScheme& time) {
  limit(flow, boundary);
  start_rows(flow, time);
  scheme_->add_interior(inputs(flow, flow.velocity), {matrix_, diagonal_, right_side_});
  add_boundary(flow, boundary);
  const auto report =
      solve_rows<Vec3>(mesh_, matrix_, diagonal_, right_side_, flow.velocity, settings_.tolerance, settings_.max_sweeps, false, coupled_);
  record_boundary(flow, boundary);
  return report;
}

FaceInputs Momentum::inputs(const Flow& flow, const std::vector<Vec3>& guess) const {
  return {.flow = flow,
          .guess = guess,
          .flux = flux_,
          .gradient = flow.velocity_gradient,
          .reconstruction = *convected_,
          .psi = psi_,
          .in_corner = in_corner_};
}

void Momentum::fluxes(const Flow& flow, const std::vector<Vec3>& guess, const std::vector<Vec3>& predicted, int first,
                      std::span<MomentumFlux> flux) const {
  scheme_->fluxes(inputs(flow, guess), predicted, first, flux);
}

void Momentum::take_given_flux(const Flow& flow, const BoundarySet& boundary) {
  if (!flow.rotating_zone || !flow.rotating_zone->slides()) return;
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    if (boundary.flux(static_cast<int>(p)) != FaceFlux::given) continue;
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f)
      if (mesh_.cell_zone[mesh_.owner[f]] == flow.rotating_zone->zone())
        flux_[f] = boundary.values().flux[f - mesh_.n_interior] - flow.mesh_flux[f];
  }
}

/// Time derivative, pressure gradient and forces; N a cell.
void Momentum::start_rows(const Flow& flow, const TimeScheme& time) {
  const double inertia = flow.density / time.dt;
  const bool has_rags = !flow.reaction.empty();
  for (int c = 0; c < mesh_.n_cells; ++c) {
    const double V = mesh_.cell_volume[c], a = V * inertia * time.now;
    diagonal_[c] = {a, a, a};
    right_side_[c] = V * ((has_rags ? flow.reaction[c] : Vec3{}) + flow.body_force - flow.pressure_gradient[c] -
                          inertia * (time.old * flow.velocity_old[c] + time.older * flow.velocity_older[c]));
  }
  if (!flow.rotating_zone) return;
  if (flow.rotating_zone->slides()) {
    const Mat3 lacking = flow.rotating_zone->turning_difference(flow.time, time);
    if (lacking == Mat3{}) return;
    for (int c = 0; c < mesh_.n_cells; ++c) {
      if (mesh_.cell_zone[c] != flow.rotating_zone->zone()) continue;
      const Vec3 second = second_difference(time, flow.velocity[c], flow.velocity_old[c], flow.velocity_older[c]);
      right_side_[c] -= mesh_.cell_volume[c] * inertia * (lacking * second);
    }
    return;
  }
  const Vec3 omega = flow.rotating_zone->rotation_speed(flow.time + time.dt);
  for (int c = 0; c < mesh_.n_cells; ++c)
    if (mesh_.cell_zone[c] == flow.rotating_zone->zone())
      right_side_[c] -= flow.density * mesh_.cell_volume[c] * cross(omega, flow.velocity[c]);
}

/// Coefficients of boundary face f with its cell P:
///   friction on the fluid = friction_source - friction_slope * u_P - coupling u_P,   convection out = convection_slope u_P +
///   convection_source
struct Momentum::BoundaryFace {
  Vec3 friction_slope, friction_source;  // kg/s, N
  Vec3 coupling;                         // of the components by friction: yz, xz, xy, kg/s
  double convection_slope = 0;           // kg/s
  Vec3 convection_source;                // N

  BoundaryFace(const Momentum& equation, const Flow& flow, const BoundarySet& boundary, int patch, int f) {
    const Mesh& mesh = equation.mesh_;
    const int P = mesh.owner[f], b = f - mesh.n_interior;
    const Vec3 &S = mesh.face_vector[f], &d = mesh.delta[f];
    const Mat3& G = flow.velocity_gradient[P];
    const double F = flow.density * equation.flux_[f], mu = flow.face_viscosity[f];
    switch (boundary.velocity_side(patch)) {
      case Side::value: {
        const Vec3& u = boundary.values().velocity[b];
        const double c = conductance(S, d);
        friction_slope = {mu * c, mu * c, mu * c};
        // Fluid that leaves carries the velocity of the cell. With the given velocity the convection would not damp the tangential velocity
        // of the cell. A convective outlet derives its velocity from the cell, which is stable in hexahedra.
        if (F > 0 && boundary.is_open(patch) && !(boundary.is_outlet(patch) && mesh.cell_shape[P] == CellShape::hexahedron))
          convection_slope = F, convection_source = F * (G * along_face(d, unit(S)));
        else
          convection_source = F * u;
        if (!flow.wall_function.empty() && flow.wall_function[b]) {
          // The shear of a wall function is all there is: mu is not that of a linear profile whose gradient could correct it.
          friction_source = mu * c * u;
          break;
        }
        friction_source = mu * (c * u + G * (S - c * d));
        if (flow.variable_viscosity) friction_source += mu * transposed_product(G, S);
        break;
      }
      case Side::slope: {
        const double area = norm(S);
        const Vec3 n = S / area;
        if (flow.variable_viscosity) friction_source = mu * transposed_product(G, S);
        if (F > 0)
          convection_slope = F, convection_source = F * (G * along_face(d, n));
        else
          convection_source = F * (equation.flux_[f] + flow.mesh_flux[f]) / area * n;
        break;
      }
      case Side::mirror: {  // only the normal part of u has a gradient along n: - mu |S| ((u - u_w).n) n / (d.n), all of it implicit: in
                            // large steps an explicit part grows. mu grad u^T adds the same again
        const double area = norm(S);
        const Vec3 n = S / area;
        const double c = (flow.variable_viscosity ? 2 : 1) * mu * area / dot(d, n);
        friction_slope = c * Vec3{n.x * n.x, n.y * n.y, n.z * n.z};
        coupling = c * Vec3{n.y * n.z, n.x * n.z, n.x * n.y};
        friction_source = c * dot(boundary.values().velocity[b], n) * n;
        break;
      }
      case Side::none:
        break;
    }
  }

  bool is_coupled() const {
    constexpr double round_off = 1e-24;  // of a plane normal to an axis
    return norm_squared(coupling) > round_off * norm_squared(friction_slope);
  }
  /// What couples the components, of the velocity u.
  Vec3 coupled(const Vec3& u) const {
    return {coupling.z * u.y + coupling.y * u.z, coupling.z * u.x + coupling.x * u.z, coupling.y * u.x + coupling.x * u.y};
  }
};

void Momentum::add_boundary(Flow& flow, const BoundarySet& boundary) {
  coupled_.clear();
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const BoundaryFace face(*this, flow, boundary, static_cast<int>(p), f);
      const int P = mesh_.owner[f], b = f - mesh_.n_interior;
      const double C = face.convection_slope;
      diagonal_[P] += face.friction_slope + Vec3{C, C, C};
      right_side_[P] += face.friction_source - face.convection_source;
      if (face.is_coupled()) coupled_.push_back({P, face.coupling});
      // The explicit parts are kept: after the solve the guess they came from is gone.
      flow.boundary_friction[b] = -face.friction_source;
      flow.boundary_convection[b] = face.convection_source;
    }
  }
  // One row a cell, ascending.
  std::stable_sort(coupled_.begin(), coupled_.end(), [](const CoupledRow& a, const CoupledRow& b) { return a.cell < b.cell; });
  std::size_t n = 0;
  for (const CoupledRow& row : coupled_) {
    if (n > 0 && coupled_[n - 1].cell == row.cell)
      coupled_[n - 1].off += row.off;
    else
      coupled_[n++] = row;
  }
  coupled_.resize(n);
}

/// Completes what the boundary faces did with the implicit parts at u*.
void Momentum::record_boundary(Flow& flow, const BoundarySet& boundary) const {
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      const BoundaryFace face(*this, flow, boundary, static_cast<int>(p), f);
      const Vec3& u = flow.velocity[mesh_.owner[f]];
      flow.boundary_friction[f - mesh_.n_interior] += scaled(face.friction_slope, u);
      if (face.is_coupled()) flow.boundary_friction[f - mesh_.n_interior] += face.coupled(u);
      flow.boundary_convection[f - mesh_.n_interior] += face.convection_slope * u;
      if (!flow.variable_viscosity && boundary.is_wall(static_cast<int>(p)))
        flow.turning_friction[f - mesh_.n_interior] =
            flow.face_viscosity[f] * cross(boundary.values().spin[f - mesh_.n_interior], mesh_.face_vector[f]);
    }
  }
}

}  // namespace snag
