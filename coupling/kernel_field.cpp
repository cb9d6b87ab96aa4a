#include "coupling/kernel_field.hpp"

#include <numeric>

namespace snag {

namespace {
enum Field { velocity = 0, gradient = 3, pressure_gradient = 12, acceleration = 15, n_fields = 18 };
}

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
  if (needed.velocity_gradient) add(flow_.velocity_gradient.data(), 9, gradient);
  if (needed.pressure_gradient) add(flow_.pressure_gradient.data(), 3, pressure_gradient);
  if (needed.material_acceleration) {
    acceleration_.resize(flow_.mesh.n_cells);
    const double rate = last_step_ > 0 ? 1 / last_step_ : 0;
    for (int c = 0; c < flow_.mesh.n_cells; ++c)
      acceleration_[c] = rate * (flow_.velocity[c] - flow_.velocity_old[c]) + flow_.velocity_gradient[c] * flow_.velocity[c];
    add(acceleration_.data(), 3, acceleration);
  }
  const std::vector<double> values = kernel_.average(fields);

  arrays_.reset(tiles, n_fields);
  const std::size_t components = field_of_component.size();
  for (std::size_t b = 0; b < particles_.size(); ++b)
    for (std::size_t j = 0; j < components; ++j)
      arrays_.field(particles_.tile(b), field_of_component[j])[particles_.place(b)] = values[b * components + j];
}

FluidSamples KernelField::at(std::size_t index, const Tile&, double) {
  const auto vector = [&](int f) { return VectorArray{arrays_.field(index, f), arrays_.field(index, f + 1), arrays_.field(index, f + 2)}; };
  return {.density = flow_.density,
          .dynamic_viscosity = flow_.dynamic_viscosity,
          .velocity = vector(velocity),
          .velocity_gradient = {vector(gradient), vector(gradient + 3), vector(gradient + 6)},
          .pressure_gradient = vector(pressure_gradient),
          .material_acceleration = vector(acceleration)};
}

}  // namespace snag
