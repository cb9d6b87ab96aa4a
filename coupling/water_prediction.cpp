#include "coupling/water_prediction.hpp"

#include <algorithm>
#include <cmath>

#include "base/flat.hpp"
#include "mesh/geometry.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace {
std::vector<Vec3> read_vectors(CheckpointReader& reader, const std::string& name, std::span<const std::int64_t> ids) {
  const std::vector<double> rows = reader.rows(name, ids, 3);
  std::vector<Vec3> vectors(rows.size() / 3);
  for (std::size_t c = 0; c < vectors.size(); ++c) vectors[c] = {rows[3 * c], rows[3 * c + 1], rows[3 * c + 2]};
  return vectors;
}

/// N/m3, zero in water without rags.
Vec3 force_of_rags(const Flow& flow, int cell) { return flow.reaction.empty() ? Vec3{} : flow.reaction[cell]; }
}  // namespace

WaterPrediction::WaterPrediction(const Flow& flow, double kernel_width) : flow_(flow) {
  for (int c = 0; c < flow.mesh.n_cells; ++c)
    resolved_.push_back(std::clamp(8 * kernel_width / std::cbrt(flow.mesh.cell_volume[c]) - 3, 0.0, 1.0));
}

void WaterPrediction::begin_step(double dt) {
  scheme_ = bdf(dt, flow_.time_step_size);
  const RotatingZone* zone = flow_.rotating_zone;
  turn_ = zone && zone->slides() ? rotation(zone->axis(), zone->angle(flow_.time + dt) - zone->angle(flow_.time)) : Mat3{};
}

/// A vector that turns with the zone of its cell, at the end of the step.
Vec3 WaterPrediction::turned(int cell, const Vec3& v) const {
  const RotatingZone* zone = flow_.rotating_zone;
  return zone && zone->slides() && flow_.mesh.cell_zone[cell] == zone->zone() ? turn_ * v : v;
}

void WaterPrediction::predict(std::span<const int> cells) {
  const double dt = scheme_.dt;
  const Mesh& mesh = flow_.mesh;
  const RotatingZone* zone = flow_.rotating_zone;
  const Vec3 omega = zone ? zone->rotation_speed(flow_.time) : Vec3{};
  for (auto* field : {&velocity_, &change_, &acceleration_}) field->resize(mesh.n_cells);
  is_settled_.resize(mesh.n_cells, 0);
  for (const int c : cells) {
    if (!resumed_ && !(flow_.frozen && is_settled_[c])) velocity_[c] = start_velocity(c), is_settled_[c] = known_;
    const Vec3& u = flow_.velocity[c];
    const Mat3& G = flow_.velocity_gradient[c];
    Vec3 change, by_rags;
    if (known_) {
      change = (1 / scheme_.now) * (dt * turned(c, rate_[c]) - scheme_.old * u - scheme_.older * flow_.velocity_old[c]) - u;
      by_rags = (dt / (scheme_.now * flow_.density)) * turned(c, force_of_rags(flow_, c));
    } else {
      change = turned(c, u) - u;
    }
    if (zone && mesh.cell_zone[c] == zone->zone()) {
      const Vec3 x = mesh.cell_centre[c] - zone->origin();
      // A zone that stands in the turning frame has its components there.
      change += zone->slides() ? -1 * (G * (turned(c, x) - x)) : dt * (cross(omega, u) - G * cross(omega, x));
    }
    change_[c] = change;
    acceleration_[c] = (1 / dt) * (change + by_rags) + G * u;
  }
}

void WaterPrediction::end_step() {
  if (flow_.time_step_size <= 0) return;
  const Mesh& mesh = flow_.mesh;
  known_ = true, resumed_ = false;
  rate_.resize(mesh.n_cells);
  for (int c = 0; c < mesh.n_cells; ++c) {
    const Vec3 difference = scheme_.now * flow_.velocity[c] + scheme_.old * flow_.velocity_old[c] + scheme_.older * flow_.velocity_older[c];
    rate_[c] = (1 / scheme_.dt) * difference - (1 / flow_.density) * force_of_rags(flow_, c);
  }
}

/// u^n of a cell from its fluxes, while the facets of the sliding interface are those that they belong to.
Vec3 WaterPrediction::start_velocity(int cell) const {
  const Vec3& u = flow_.velocity[cell];
  if (!known_ || resolved_[cell] == 0) return u;
  const Mesh& mesh = flow_.mesh;
  Vec3 moment;
  int previous = -1;
  for (const int f : row(mesh.cell_face_start, mesh.cell_face, cell)) {
    const bool is_owner = mesh.owner[f] == cell && f != previous;  // a cell that is its own neighbour lists the face twice
    previous = f;
    const Vec3 way = mesh.face_centre[f] - mesh.cell_centre[mesh.owner[f]] - (is_owner ? Vec3{} : mesh.delta[f]);
    moment += (is_owner ? 1 : -1) * (flow_.flux[f] - dot(flow_.velocity_gradient[cell] * way, mesh.face_vector[f])) * way;
  }
  return u + resolved_[cell] * ((1 / mesh.cell_volume[cell]) * moment - u);
}

std::vector<double> WaterPrediction::response(const Kernel& kernel) const {
  std::vector<double> density(flow_.mesh.n_cells, 0.0);
  kernel.spread(std::vector<double>(kernel.n_particles(), 1.0), 1, density);
  const CellField field{density.data(), 1};
  std::vector<double> at_particles = kernel.average(std::span(&field, 1));
  for (double& d : at_particles) d /= flow_.density;
  return at_particles;
}

std::vector<Vec3> WaterPrediction::missed_rates(const Kernel& kernel, std::span<const double> response, std::span<const Vec3> given) const {
  const std::vector<Vec3> reaction = kernel.average(std::span<const Vec3>(flow_.reaction));
  std::vector<double> missed(3 * given.size());  // m
  for (std::size_t b = 0; b < given.size(); ++b) {
    const Vec3 m = (1 / scheme_.now) * ((response[b] / scheme_.dt) * given[b] + (1 / flow_.density) * reaction[b]);
    for (int i = 0; i < 3; ++i) missed[3 * b + i] = m[i];
  }
  std::vector<Vec3> density(flow_.mesh.n_cells);
  kernel.spread(missed, 3, flat(density));
  for (int c = 0; c < flow_.mesh.n_cells; ++c) density[c] = resolved_[c] * turned(c, density[c]);
  std::vector<Vec3> rates = kernel.average(std::span<const Vec3>(density));
  for (std::size_t b = 0; b < rates.size(); ++b) rates[b] = (1 / (flow_.density * response[b])) * rates[b];  // A S^T 1
  return rates;
}

void WaterPrediction::save(CheckpointWriter& writer) const {
  if (!known_) return;
  writer.rows("coupling/rate", owned_ids(), flat(rate_), 3);
  std::vector<Vec3> velocity = velocity_;
  velocity.resize(flow_.mesh.n_cells);
  for (int c = 0; !resumed_ && c < flow_.mesh.n_cells; ++c) velocity[c] = start_velocity(c);
  writer.rows("coupling/velocity", owned_ids(), flat(velocity), 3);
}

void WaterPrediction::load(CheckpointReader& reader) {
  known_ = reader.has("coupling/rate");
  if (!known_) return;
  rate_ = read_vectors(reader, "coupling/rate", owned_ids());
  velocity_ = read_vectors(reader, "coupling/velocity", owned_ids());
  resumed_ = true;
}

std::span<const std::int64_t> WaterPrediction::owned_ids() const {
  return {flow_.mesh.cell_id.data(), static_cast<std::size_t>(flow_.mesh.n_cells)};
}

}  // namespace snag
