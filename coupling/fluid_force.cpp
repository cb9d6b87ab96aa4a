#include "coupling/fluid_force.hpp"

#include <algorithm>
#include <numbers>

#include "base/words.hpp"
#include "dem/templates/lattice.hpp"

namespace snag {

Particles::Particles(const Rag& rag_, const Tile& tile_)
    : rag(rag_),
      tile(tile_),
      begin(tile_.index(0, 0)),
      end(tile_.index(tile_.nx - 1, tile_.ny - 1) + 1),
      position{tile_.field(Tile::x), tile_.field(Tile::y), tile_.field(Tile::z)},
      velocity{tile_.field(Tile::vx), tile_.field(Tile::vy), tile_.field(Tile::vz)},
      angular_velocity{tile_.field(Tile::wx), tile_.field(Tile::wy), tile_.field(Tile::wz)},
      diameter(rag_.hydrodynamic_diameter),
      mass(rag_.mass),
      volume(rag_.hydrodynamic_volume) {}

Registry<FluidForce>& fluid_forces() {
  static Registry<FluidForce> registry("fluid force");
  return registry;
}

std::int64_t Particles::id(int column, int row) const { return particle_id(rag, tile, column, row); }

namespace {

/// The sphere in the middle of a tile of 3 x 3, with the neighbours that it has.
Tile tile_of_sphere(const SphereState& state) {
  Tile tile;
  tile.allocate(3, 3);
  const auto mark = [](AlignedDoubles& marks, int place) { marks[static_cast<std::size_t>(place)] = 1; };
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const bool row = i == 1 || (norm(state.next_in_row) > 0 && !(state.begins_row && i == 0)),
                 column = j == 1 || norm(state.next_row) > 0;
      const int k = tile.index(i, j);
      tile.set_vector(Tile::x, k, state.position + (i - 1) * state.next_in_row + (j - 1) * state.next_row);
      tile.set_vector(Tile::vx, k, state.velocity);
      tile.set_vector(Tile::wx, k, state.angular_velocity);
      if (!row || !column) continue;
      mark(tile.exists, k), mark(tile.free, k);
      if (i < 2 && norm(state.next_in_row) > 0) mark(tile.bond_x, k);
      if (j < 2 && norm(state.next_row) > 0) mark(tile.bond_y, k);
    }
  return tile;
}

/// Fields of a tile that hold the same number everywhere.
struct UniformFields {
  explicit UniformFields(std::size_t size_) : size(size_) { values.reserve(64 * size); }
  double* field(double value) {
    values.resize(values.size() + size, value);
    return values.data() + values.size() - size;
  }
  VectorArray vector(const Vec3& v) { return {field(v.x), field(v.y), field(v.z)}; }
  VectorSum sum(const Vec3& v = {}) { return {field(v.x), field(v.y), field(v.z)}; }
  std::size_t size;
  std::vector<double> values;
};

/// |F|/|w| of the drag alone.
const double* drag_before(const FluidForce& drag, const FluidSamples& fluid, const Particles& particles, UniformFields& fields) {
  const Forces forces{fields.sum(), fields.sum(), fields.field(0), fields.field(0)};
  drag.add(fluid, particles, forces);
  return forces.slope;
}

}  // namespace

SphereLoad load_on_sphere(const FluidForce& force, const SphereState& state) {
  const double d = state.diameter, volume = std::numbers::pi / 6 * d * d * d;
  Rag rag;
  rag.n_columns = rag.n_rows = 3;
  rag.radius = d / 2, rag.hydrodynamic_diameter = d, rag.hydrodynamic_volume = volume, rag.mass = state.particle_density * volume;
  rag.inertia = 0.1 * rag.mass * d * d;
  const Tile tile = tile_of_sphere(state);
  rag.n_particles = std::count(tile.exists.begin(), tile.exists.end(), 1.0);

  UniformFields fields(tile.field_size);
  const auto& G = state.velocity_gradient;
  const VectorSum velocity = fields.sum(state.fluid_velocity);
  FluidSamples fluid{.density = state.fluid_density,
                     .dynamic_viscosity = state.dynamic_viscosity,
                     .velocity = {velocity.x, velocity.y, velocity.z},
                     .velocity_gradient = {fields.vector(G[0]), fields.vector(G[1]), fields.vector(G[2])}};
  for (const SampleRow& row : sample_rows()) {
    if (!row.of_sphere) continue;
    const Vec3 value = row.of_sphere(state);
    const double* arrays[3] = {};
    for (int i = 0; i < row.components(); ++i) arrays[i] = fields.field(value[i]);
    row.point(fluid, arrays);
  }
  const Forces forces{fields.sum(), fields.sum(), fields.field(0), fields.field(0), fields.field(0), velocity, fields.field(1)};
  const ForceDescription description = force.description();
  std::vector<double> particle_state(static_cast<std::size_t>(description.n_particle_state) * tile.field_size);
  Particles particles(rag, tile);
  particles.step = state.step;
  particles.state = particle_state.data(), particles.state_stride = tile.field_size;
  const bool changes_drag = description.role == Role::drag_replacement || description.role == Role::drag_modifier;
  const auto drag = fluid_forces().make("schiller_naumann", "sphere");
  if (changes_drag) drag->add(fluid, particles, forces);
  if (description.needs_drag) particles.last_drag = drag_before(*drag, fluid, particles, fields);
  force.add(fluid, particles, forces);
  if (description.role == Role::fluid) drag->add(fluid, particles, forces);
  const int k = tile.index(1, 1);
  const auto at = [k](const VectorSum& v) { return Vec3{v.x[k], v.y[k], v.z[k]}; };
  return {at(forces.force), at(forces.torque), forces.slope[k], forces.added_mass[k]};
}

ReferenceCase drag_at(double Re, double drag_coefficient, double tolerance, const std::string& source) {
  SphereState state;
  const double d = state.diameter, rho = state.fluid_density;
  const double speed = Re * state.dynamic_viscosity / (rho * d);
  state.velocity = {-speed, 0, 0};
  return {.what = "sphere at Re = " + number_text(Re),
          .source = source,
          .state = state,
          .force = {0.5 * rho * drag_coefficient * std::numbers::pi / 4 * d * d * speed * speed, 0, 0},
          .tolerance = tolerance};
}

ReferenceCase stokes_limit() {
  constexpr double Re = 1e-6;
  auto reference = drag_at(Re, 24 / Re, 1e-4, "Stokes (1851): F = 3 pi mu d w");
  reference.what = "creeping flow";
  return reference;
}

}  // namespace snag
