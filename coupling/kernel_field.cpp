#include "coupling/kernel_field.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

using namespace sampled;

void KernelField::sample(std::span<const Tile> tiles, const SampleSet& needed) {
  particles_ = ParticleList(tiles);
  std::vector<Vec3> points(particles_.size());
  for (std::size_t b = 0; b < points.size(); ++b) points[b] = tiles[particles_.tile(b)].vector(Tile::x, particles_.place(b));
  kernel_.locate(points);

  std::vector<CellField> fields;
  std::vector<int> field_of_component;
  const auto add = [&](const void* values, int components, int first) {
    fields.push_back({static_cast<const double*>(values), components});
    for (int j = 0; j < components; ++j) field_of_component.push_back(first + j);
  };
  add(flow_.velocity.data(), 3, velocity);
  add(flow_.velocity_gradient.data(), 9, gradient);
  add(prediction_.change().data(), 3, change);
  if (needed.pressure_gradient) add(flow_.pressure_gradient.data(), 3, pressure_gradient);
  if (needed.material_acceleration) add(prediction_.acceleration().data(), 3, acceleration);
  if (needed.turbulence) {
    set_turbulence_gradient();
    add(flow_.turbulent_kinetic_energy.data(), 1, k), add(flow_.dissipation_rate.data(), 1, epsilon);
    add(k_gradient_.data(), 3, k_gradient);
  }
  if (needed.solid_fraction) set_solid_fraction(tiles), add(solid_.data(), 1, solid);
  if (needed.disturbance) set_width(), add(width_.data(), 1, width);
  if (needed.coverage) set_coverage(tiles), add(covered_.data(), 1, coverage);
  const std::vector<double> values = kernel_.average(fields);

  arrays_.reset(tiles, n_fields);
  const std::size_t components = field_of_component.size();
  for (std::size_t b = 0; b < particles_.size(); ++b)
    for (std::size_t j = 0; j < components; ++j)
      arrays_.field(particles_.tile(b), field_of_component[j])[particles_.place(b)] = values[b * components + j];
  const double over_dt = 1 / prediction_.dt();
  const std::vector<double> answers = two_way_ ? prediction_.response(kernel_) : std::vector<double>();
  for (std::size_t b = 0; b < particles_.size(); ++b) {
    const int t = particles_.tile(b), k = particles_.place(b);
    for (int i = 0; i < 3; ++i) {
      arrays_.field(t, change + i)[k] *= over_dt;
      arrays_.field(t, start + i)[k] = points[b][i];
    }
    if (two_way_) arrays_.field(t, sampled::response)[k] = answers[b];
  }
}

/// At boundaries k of the cell counts: the slope towards a wall is that on the side of the fluid.
void KernelField::set_turbulence_gradient() {
  const Mesh& mesh = flow_.mesh;
  const std::vector<double>& value = flow_.turbulent_kinetic_energy;
  if (value.empty())
    throw Error(ExitCode::usage,
                "[coupling] forces: turbulent_dispersion needs k and epsilon, but this flow has none; give [turbulence] model = "
                "\"k_epsilon\", or remove the force");
  k_gradient_.assign(mesh.n_cells, {});
  for (int f = 0; f < mesh.n_faces; ++f) {
    const int owner = mesh.owner[f], neighbour = f < mesh.n_interior ? mesh.neighbour[f] : -1;
    const double at_face = neighbour < 0 ? value[owner] : mesh.weight[f] * value[owner] + (1 - mesh.weight[f]) * value[neighbour];
    if (owner < mesh.n_cells) k_gradient_[owner] += at_face / mesh.cell_volume[owner] * mesh.face_vector[f];
    if (neighbour >= 0 && neighbour < mesh.n_cells) k_gradient_[neighbour] -= at_face / mesh.cell_volume[neighbour] * mesh.face_vector[f];
  }
}

/// Kernel and cell together: on cells of side h a force in one cell answers there with 0.2527/h of the discrete Laplacian (Watson 1939), as
/// a Gaussian of width 0.178 h does.
void KernelField::set_width() {
  constexpr double width_over_side = 0.178;
  const double own = kernel_.has_width() ? kernel_.width() : 0;
  width_.assign(flow_.mesh.n_cells, undisturbed);
  if (!two_way_) return;
  for (int c = 0; c < flow_.mesh.n_cells; ++c) {
    const double side = std::cbrt(flow_.mesh.cell_volume[c]);
    width_[c] = std::hypot(own, width_over_side * side);
  }
}

void KernelField::set_solid_fraction(std::span<const Tile> tiles) {
  std::vector<double> volume(particles_.size());
  for (std::size_t b = 0; b < volume.size(); ++b) volume[b] = rags_[tiles[particles_.tile(b)].rag].hydrodynamic_volume;
  solid_.assign(flow_.mesh.n_cells, 0.0);
  kernel_.spread(volume, 1, solid_);
}

/// Areas spread by the kernel, times the thickness that a flat sheet is smeared over: averaged back they are 1 inside a flat sheet. A cell
/// adds its own size to the kernel's.
void KernelField::set_coverage(std::span<const Tile> tiles) {
  const double own = kernel_.has_width() ? 2 * std::sqrt(std::numbers::pi) * kernel_.width() : 0;
  std::vector<double> area(particles_.size());
  for (std::size_t b = 0; b < area.size(); ++b) {
    const double side = 2 * rags_[tiles[particles_.tile(b)].rag].radius;
    area[b] = side * side;
  }
  covered_.assign(flow_.mesh.n_cells, 0.0);
  kernel_.spread(area, 1, covered_);
  for (int c = 0; c < flow_.mesh.n_cells; ++c) covered_[c] *= std::hypot(own, std::cbrt(flow_.mesh.cell_volume[c]));
}

FluidSamples KernelField::at(std::size_t index, const Tile&, double) {
  const auto vector = [&](int f) { return VectorArray{arrays_.field(index, f), arrays_.field(index, f + 1), arrays_.field(index, f + 2)}; };
  return {.density = flow_.density,
          .dynamic_viscosity = flow_.dynamic_viscosity,
          .velocity = vector(velocity),
          .velocity_rate = vector(change),
          .start = vector(start),
          .response = two_way_ ? arrays_.field(index, sampled::response) : nullptr,
          .velocity_gradient = {vector(gradient), vector(gradient + 3), vector(gradient + 6)},
          .pressure_gradient = vector(pressure_gradient),
          .material_acceleration = vector(acceleration),
          .turbulent_kinetic_energy = arrays_.field(index, k),
          .dissipation_rate = arrays_.field(index, epsilon),
          .turbulent_kinetic_energy_gradient = vector(k_gradient),
          .solid_fraction = arrays_.field(index, solid),
          .disturbance_width = arrays_.field(index, width),
          .coverage = arrays_.field(index, coverage)};
}

}  // namespace snag
