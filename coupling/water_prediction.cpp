#include "coupling/water_prediction.hpp"

#include "solver/fields/rotating_zone.hpp"

namespace snag {

void WaterPrediction::begin_step(double dt) {
  scheme_ = bdf(dt, flow_.time_step_size);
  const Mesh& mesh = flow_.mesh;
  const RotatingZone* zone = flow_.rotating_zone;
  const Vec3 omega = zone ? zone->rotation_speed(flow_.time) : Vec3{};
  const Mat3 R = zone && zone->slides() ? rotation(zone->axis(), zone->angle(flow_.time + dt) - zone->angle(flow_.time)) : Mat3{};
  const bool slides = zone && zone->slides();
  change_.resize(mesh.n_cells), acceleration_.resize(mesh.n_cells);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const bool turns = zone && mesh.cell_zone[c] == zone->zone();
    const auto turned = [&](const Vec3& v) { return turns && slides ? R * v : v; };
    const Vec3& u = flow_.velocity[c];
    const Mat3& G = flow_.velocity_gradient[c];
    Vec3 change, by_rags;
    if (known_) {
      change = (1 / scheme_.now) * (dt * turned(rate_[c]) - scheme_.old * u - scheme_.older * flow_.velocity_old[c]) - u;
      by_rags = (dt / (scheme_.now * flow_.density)) * turned(flow_.reaction[c]);
    } else {
      change = turned(u) - u;
    }
    if (turns) {
      const Vec3 x = mesh.cell_centre[c] - zone->origin();
      // A zone that stands in the turning frame has its components there.
      change += slides ? -1 * (G * (turned(x) - x)) : dt * (cross(omega, u) - G * cross(omega, x));
    }
    change_[c] = change;
    acceleration_[c] = (1 / dt) * (change + by_rags) + G * u;
  }
}

void WaterPrediction::end_step() {
  if (flow_.time_step_size <= 0) return;
  const Mesh& mesh = flow_.mesh;
  known_ = true;
  rate_.resize(mesh.n_cells);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3 difference = scheme_.now * flow_.velocity[c] + scheme_.old * flow_.velocity_old[c] + scheme_.older * flow_.velocity_older[c];
    rate_[c] = (1 / scheme_.dt) * difference - (1 / flow_.density) * flow_.reaction[c];
  }
}

std::vector<double> WaterPrediction::response(const Kernel& kernel) const {
  std::vector<double> density(flow_.mesh.n_cells, 0.0);
  kernel.spread(std::vector<double>(kernel.n_particles(), 1.0), 1, density);
  const CellField field{density.data(), 1};
  std::vector<double> at_particles = kernel.average(std::span(&field, 1));
  for (double& d : at_particles) d /= scheme_.now * flow_.density;
  return at_particles;
}

void WaterPrediction::save(CheckpointWriter& writer) const {
  if (known_) writer.rows("coupling/rate", owned_ids(), std::span(rate_.empty() ? nullptr : &rate_[0].x, 3 * rate_.size()), 3);
}

void WaterPrediction::load(CheckpointReader& reader) {
  known_ = reader.has("coupling/rate");
  if (!known_) return;
  const std::vector<double> rows = reader.rows("coupling/rate", owned_ids(), 3);
  rate_.resize(rows.size() / 3);
  for (std::size_t c = 0; c < rate_.size(); ++c) rate_[c] = {rows[3 * c], rows[3 * c + 1], rows[3 * c + 2]};
}

std::span<const std::int64_t> WaterPrediction::owned_ids() const {
  return {flow_.mesh.cell_id.data(), static_cast<std::size_t>(flow_.mesh.n_cells)};
}

}  // namespace snag
