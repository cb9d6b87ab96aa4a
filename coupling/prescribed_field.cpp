#include "coupling/prescribed_field.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace snag {

namespace {

constexpr double water_viscosity = 1.003e-3;  // Pa s, at 20 degrees Celsius
using namespace sampled;

}  // namespace

Section PrescribedFlow::section() {
  return {
      "flow",
      "A flow given as a formula, without a mesh: u_i(x, t) = velocity_i + sum_j gradient_ij x_j + amplitude_i sin(omega_i t + phase_i).",
      {setting("kind", &kind, "How the water is known.", {"prescribed"}),
       {"density", &density, "kg/m3", 1e-3, 1e5, Basis::literature, "Density of the fluid; water at 20 degrees Celsius."},
       {"dynamic_viscosity", &dynamic_viscosity, "Pa s", 1e-9, 1e4, Basis::literature, "Viscosity; water at 20 degrees if none is given."},
       {"kinematic_viscosity", &kinematic_viscosity, "m2/s", 1e-12, 10, Basis::literature, "Viscosity over density, instead."},
       {"velocity", &velocity, "m/s", -1e3, 1e3, Basis::assumed, "Uniform part of the velocity."},
       {"gradient", &gradient, "1/s", -1e6, 1e6, Basis::assumed, "Velocity gradient, row i: du_i/dx, du_i/dy, du_i/dz."},
       {"amplitude", &amplitude, "m/s", -1e3, 1e3, Basis::assumed, "Amplitude of the oscillating part."},
       {"omega", &omega, "1/s", 0, 1e6, Basis::assumed, "Angular frequency of the oscillating part."},
       {"phase", &phase, "rad", -10, 10, Basis::assumed, "Phase of the oscillating part at t = 0."},
       {"turbulent_kinetic_energy", &turbulent_kinetic_energy, "m2/s2", 0, 1e4, Basis::assumed,
        "k at the origin, of turbulence that the formula does not hold."},
       {"turbulent_kinetic_energy_gradient", &turbulent_kinetic_energy_gradient, "m/s2", -1e4, 1e4, Basis::assumed,
        "Gradient of k; where k would be negative it is zero."},
       {"dissipation_rate", &dissipation_rate, "m2/s3", 0, 1e6, Basis::assumed, "epsilon of that turbulence."}}};
}

double PrescribedFlow::viscosity() const {
  if (dynamic_viscosity && kinematic_viscosity)
    throw Error(ExitCode::usage, "[flow]: dynamic_viscosity and kinematic_viscosity are both given; leave one of them out");
  if (kinematic_viscosity) return *kinematic_viscosity * density;
  return dynamic_viscosity.value_or(water_viscosity);
}

void PrescribedField::sample(std::span<const Tile> tiles, const SampleSet& needed) {
  needed_ = needed;
  arrays_.fit(tiles, n_fields);
  if (!needed.disturbance) return;
  for (std::size_t t = 0; t < tiles.size(); ++t) std::fill_n(arrays_.field(t, width), tiles[t].exists.size(), undisturbed);
}

FluidSamples PrescribedField::at(std::size_t index, const Tile& tile, double elapsed) {
  const double t = time_ + elapsed;
  Vec3 uniform, rate;  // the part of u that is the same everywhere, and its time derivative
  for (int i = 0; i < 3; ++i) {
    uniform[i] = flow_.velocity[i];
    if (flow_.amplitude[i] == 0) continue;
    const double angle = flow_.omega[i] * t + flow_.phase[i];
    uniform[i] += flow_.amplitude[i] * std::sin(angle);
    rate[i] = flow_.amplitude[i] * flow_.omega[i] * std::cos(angle);
  }
  const auto vector = [&](int f) { return VectorSum{arrays_.field(index, f), arrays_.field(index, f + 1), arrays_.field(index, f + 2)}; };
  const auto set = [](const VectorSum& to, int p, const Vec3& v) { to.x[p] = v.x, to.y[p] = v.y, to.z[p] = v.z; };
  const VectorSum u_at = vector(velocity), p_at = vector(pressure_gradient), a_at = vector(acceleration);
  const std::array G_at{vector(gradient), vector(gradient + 3), vector(gradient + 6)};
  const Mat3& G = flow_.gradient;
  for (int p = tile.index(0, 0); p < tile.index(tile.nx, tile.ny - 1); ++p) {
    const Vec3 u = uniform + G * tile.vector(Tile::x, p);
    set(u_at, p, u);
    if (needed_.velocity_gradient)
      for (int i = 0; i < 3; ++i) set(G_at[i], p, G[i]);
    if (needed_.turbulence) {
      const Vec3& slope = flow_.turbulent_kinetic_energy_gradient;
      const double here = flow_.turbulent_kinetic_energy + dot(slope, tile.vector(Tile::x, p));
      arrays_.field(index, k)[p] = std::max(here, 0.0);
      arrays_.field(index, epsilon)[p] = flow_.dissipation_rate;
      set(vector(k_gradient), p, here > 0 ? slope : Vec3{});
    }
    if (!needed_.material_acceleration && !needed_.pressure_gradient) continue;
    const Vec3 acceleration_here = rate + G * u;
    set(a_at, p, acceleration_here);
    set(p_at, p, -flow_.density * acceleration_here);
  }
  const auto array = [](const VectorSum& v) { return VectorArray{v.x, v.y, v.z}; };
  return {.density = flow_.density,
          .dynamic_viscosity = viscosity_,
          .velocity = array(u_at),
          .velocity_gradient = {array(G_at[0]), array(G_at[1]), array(G_at[2])},
          .pressure_gradient = array(p_at),
          .material_acceleration = array(a_at),
          .turbulent_kinetic_energy = arrays_.field(index, k),
          .dissipation_rate = arrays_.field(index, epsilon),
          .turbulent_kinetic_energy_gradient = array(vector(k_gradient)),
          .solid_fraction = arrays_.field(index, solid),
          .disturbance_width = arrays_.field(index, width)};
}

}  // namespace snag
