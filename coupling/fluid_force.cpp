#include "coupling/fluid_force.hpp"

#include <numbers>

#include "base/words.hpp"

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

SphereLoad load_on_sphere(const FluidForce& force, const SphereState& state) {
  const double d = state.diameter, volume = std::numbers::pi / 6 * d * d * d;
  Rag rag;
  rag.radius = d / 2, rag.hydrodynamic_diameter = d, rag.hydrodynamic_volume = volume, rag.mass = state.particle_density * volume;
  rag.inertia = 0.1 * rag.mass * d * d;

  Tile tile;
  tile.allocate(1, 1);
  const int k = tile.index(0, 0);
  tile.exists[k] = 1;
  tile.set_vector(Tile::x, k, state.position);
  tile.set_vector(Tile::vx, k, state.velocity);
  tile.set_vector(Tile::wx, k, state.angular_velocity);

  // Arrays of the tile's size, of which place k is used.
  std::vector<double> values;
  values.reserve(26 * tile.field_size);
  const auto array = [&values, &tile, k](double value) {
    double* first = values.data() + values.size();
    values.resize(values.size() + tile.field_size);
    first[k] = value;
    return first;
  };
  const auto vector = [&array](const Vec3& v) { return VectorArray{array(v.x), array(v.y), array(v.z)}; };
  const auto sum = [&array] { return VectorSum{array(0), array(0), array(0)}; };
  const auto& G = state.velocity_gradient;
  const FluidSamples fluid{.density = state.fluid_density,
                           .dynamic_viscosity = state.dynamic_viscosity,
                           .velocity = vector(state.fluid_velocity),
                           .velocity_gradient = {vector(G[0]), vector(G[1]), vector(G[2])},
                           .pressure_gradient = vector(state.pressure_gradient),
                           .material_acceleration = vector(state.material_acceleration)};
  const Forces forces{sum(), sum(), array(0), array(0)};
  force.add(fluid, Particles(rag, tile), forces);
  const auto at = [k](const VectorSum& v) { return Vec3{v.x[k], v.y[k], v.z[k]}; };
  return {at(forces.force), at(forces.torque), forces.slope[k], forces.added_mass[k]};
}

ReferenceCase drag_at(double Re, double drag_coefficient, double tolerance, const std::string& source) {
  SphereState state;
  const double d = state.diameter, rho = state.fluid_density;
  const double speed = Re * state.dynamic_viscosity / (rho * d);
  state.velocity = {-speed, 0, 0};
  return {.what = "sphere at Re = " + words(Re),
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
