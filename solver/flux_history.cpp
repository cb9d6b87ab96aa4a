#include "solver/flux_history.hpp"

#include <algorithm>

#include "mesh/sliding/turning_mesh.hpp"

namespace snag {

namespace {

constexpr double slower_on_tetrahedra = 4;  // C

}  // namespace

FluxHistory::FluxHistory(const Mesh& mesh, Workspace& workspace)
    : deviation(mesh.n_faces),
      deviation_old(mesh.n_faces),
      mesh_(mesh),
      pressure_share_(mesh.n_faces, 1.0),
      rate_(workspace.scalar_in(workspace.vector[0], 2)) {}

void FluxHistory::mesh_turned() {
  resize_facets(mesh_, deviation), resize_facets(mesh_, deviation_old), resize_facets(mesh_, pressure_share_);
}

void FluxHistory::begin_step(std::span<const double> convection, std::span<const double> diffusion, std::span<const double> mesh_flux,
                             const TimeScheme& time) {
  set_rate(convection, diffusion, mesh_flux);
  for (int f = 0; f < mesh_.n_faces; ++f) {
    const int P = mesh_.owner[f], N = f < mesh_.n_interior ? mesh_.neighbour[f] : P;
    const double share = 1 / (time.now + 0.5 * (rate_[P] + rate_[N]) * time.dt);  // sigma/a0
    pressure_share_[f] = time.now * share;
    deviation_old[f] = -share * (time.old * deviation[f] + time.older * deviation_old[f]);
  }
  std::fill(deviation_old.begin() + mesh_.first_facet, deviation_old.begin() + mesh_.n_interior, 0.0);  // facets inherit nothing
}

/// kappa/C of all cells.
void FluxHistory::set_rate(std::span<const double> convection, std::span<const double> diffusion, std::span<const double> mesh_flux) {
  std::fill(rate_.begin(), rate_.end(), 0.0);
  if (mesh_.turning.zone >= 0)
    for (int f = 0; f < mesh_.n_faces; ++f) {
      rate_[mesh_.owner[f]] += std::max(mesh_flux[f], 0.0);
      if (f < mesh_.n_interior) rate_[mesh_.neighbour[f]] += std::max(-mesh_flux[f], 0.0);
    }
  for (int c = 0; c < mesh_.n_cells; ++c) {
    const double slower = mesh_.cell_shape[c] == CellShape::tetrahedron ? slower_on_tetrahedra : 1;
    rate_[c] = (convection[c] + diffusion[c] + rate_[c]) / (slower * mesh_.cell_volume[c]);
  }
  mesh_.halo.exchange(rate_);
}

}  // namespace snag
