#include "coupling/water_response.hpp"

#include "solver/fields/rotating_zone.hpp"

namespace snag {

void WaterResponse::begin_step(double dt) {
  scheme_ = bdf(dt, flow_.time_step_size);
  const Mesh& mesh = flow_.mesh;
  change_.assign(mesh.n_cells, {});
  if (!known_) return;
  const RotatingZone* turning = flow_.rotating_zone;
  const Vec3 omega = turning ? turning->rotation_speed(flow_.time) : Vec3{};
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3& u = flow_.velocity[c];
    const Vec3 history = -scheme_.old * u - scheme_.older * flow_.velocity_old[c];
    change_[c] = (1 / scheme_.now) * (dt * rate_[c] + history) - u;
    // The cell moves on; the particle stays where the water is looked at.
    if (turning && mesh.cell_zone[c] == turning->zone())
      change_[c] -= dt * (flow_.velocity_gradient[c] * cross(omega, mesh.cell_centre[c] - turning->origin()));
  }
}

void WaterResponse::end_step() {
  if (flow_.time_step_size <= 0) return;
  const Mesh& mesh = flow_.mesh;
  known_ = true;
  rate_.resize(mesh.n_cells);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3 difference = scheme_.now * flow_.velocity[c] + scheme_.old * flow_.velocity_old[c] + scheme_.older * flow_.velocity_older[c];
    rate_[c] = (1 / scheme_.dt) * difference - (1 / flow_.density) * flow_.reaction[c];
  }
}

std::vector<double> WaterResponse::response(const Kernel& kernel) const {
  std::vector<double> density(flow_.mesh.n_cells, 0.0);
  kernel.spread(std::vector<double>(kernel.n_particles(), 1.0), 1, density);
  const CellField field{density.data(), 1};
  std::vector<double> at_particles = kernel.average(std::span(&field, 1));
  for (double& d : at_particles) d /= scheme_.now * flow_.density;
  return at_particles;
}

void WaterResponse::save(CheckpointWriter& writer) const {
  if (known_) writer.rows("coupling/rate", owned_ids(), std::span(rate_.empty() ? nullptr : &rate_[0].x, 3 * rate_.size()), 3);
}

void WaterResponse::load(CheckpointReader& reader) {
  known_ = reader.has("coupling/rate");
  if (!known_) return;
  const std::vector<double> rows = reader.rows("coupling/rate", owned_ids(), 3);
  rate_.resize(rows.size() / 3);
  for (std::size_t c = 0; c < rate_.size(); ++c) rate_[c] = {rows[3 * c], rows[3 * c + 1], rows[3 * c + 2]};
}

std::span<const std::int64_t> WaterResponse::owned_ids() const {
  return {flow_.mesh.cell_id.data(), static_cast<std::size_t>(flow_.mesh.n_cells)};
}

}  // namespace snag
