// Explicit in psi:   inherited = - s (a1 psi^n + a2 psi^(n-1) + kappa dt (extrapolated psi)),   s = min(max(2 - kappa dt, 0), 1)
// Stable to kappa dt = 4/3 with BDF2. Above 1 a face inherits less, above 2 nothing: what it would keep there is no longer that of the
// equation, and on skew cells, whose interpolated flux is far from the true one, it drove pressure and velocity apart.
#include "solver/flux_history.hpp"

#include <algorithm>

#include "mesh/sliding/turning_mesh.hpp"
#include "solver/fields/face.hpp"

namespace snag {

FluxHistory::FluxHistory(const Mesh& mesh, Workspace& workspace)
    : deviation(mesh.n_faces), deviation_old(mesh.n_faces), mesh_(mesh), swept_(workspace.scalar_in(workspace.vector[0], 2)) {}

void FluxHistory::mesh_turned() { resize_facets(mesh_, deviation), resize_facets(mesh_, deviation_old); }

void FluxHistory::begin_step(std::span<const double> convection, std::span<const double> diffusion, std::span<const double> mesh_flux,
                             const TimeScheme& time) {
  std::fill(swept_.begin(), swept_.end(), 0.0);
  if (mesh_.turning.zone >= 0) {
    for (int f = 0; f < mesh_.n_faces; ++f) {
      swept_[mesh_.owner[f]] += std::max(mesh_flux[f], 0.0);
      if (f < mesh_.n_interior) swept_[mesh_.neighbour[f]] += std::max(-mesh_flux[f], 0.0);
    }
    mesh_.halo.exchange(swept_);
  }
  const auto rate_of = [&](int c) { return (convection[c] + diffusion[c] + swept_[c]) / mesh_.cell_volume[c]; };
  for (int f = 0; f < mesh_.n_faces; ++f) {
    if (f == mesh_.first_facet) {  // facets inherit nothing
      std::fill(deviation_old.begin() + f, deviation_old.begin() + mesh_.n_interior, 0.0);
      f = mesh_.n_interior;
      if (f == mesh_.n_faces) break;
    }
    const int P = mesh_.owner[f], N = f < mesh_.n_interior ? mesh_.neighbour[f] : P;
    const double fading = 0.5 * (rate_of(P) + rate_of(N)) * time.dt;
    const double kept = std::clamp(2 - fading, 0.0, 1.0);
    const double psi = deviation[f], psi_old = deviation_old[f];
    deviation_old[f] = -kept * (time.old * psi + time.older * psi_old + fading * ((1 + time.ratio) * psi - time.ratio * psi_old));
  }
}

void FluxHistory::end_step(const Flow& flow, const std::vector<Mat3>& gradient) {
  std::swap(deviation, deviation_old);
  const auto& u = flow.velocity;
  for (int f = 0; f < mesh_.n_interior; ++f) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    deviation[f] = flow.flux[f] - dot(blend(mesh_.weight[f], u[P], u[N]), mesh_.face_vector[f]) - deviation[f];
  }
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f) {
    const int P = mesh_.owner[f];
    deviation[f] = flow.flux[f] - leaving_flux(mesh_, f, u[P], gradient[P]);
  }
}

}  // namespace snag
