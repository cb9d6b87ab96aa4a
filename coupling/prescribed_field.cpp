#include "coupling/prescribed_field.hpp"

#include <algorithm>
#include <cmath>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

constexpr double rounding_of_divergence = 1e-3;  // of the gradient: numbers of a case file have three digits or more
constexpr double water_viscosity = 1.003e-3;     // Pa s, at 20 degrees Celsius
using namespace sampled;

}  // namespace

Section PrescribedFlow::section() {
  return {"flow",
          "A flow given as a formula, without a mesh: u_i(x, t) = velocity_i + sum_j gradient_ij x_j + amplitude_i sin(angular_frequency_i "
          "t + phase_i).",
          {setting("kind", &kind, "Kind of the flow.", {"prescribed"}),
           {"density", &density, "kg/m3", 1e-6, 1e6, Basis::literature, "Density of the fluid; water at 20 degrees Celsius."},
           {"dynamic_viscosity", &dynamic_viscosity, "Pa s", 1e-9, 1e4, Basis::literature,
            "Dynamic viscosity; by default that of water at 20 degrees Celsius."},
           {"kinematic_viscosity", &kinematic_viscosity, "m2/s", 1e-12, 10, Basis::literature,
            "Kinematic viscosity, instead of dynamic_viscosity."},
           {"velocity", &velocity, "m/s", -1e3, 1e3, Basis::assumed, "Uniform part of the velocity."},
           {"gradient", &gradient, "1/s", -1e6, 1e6, Basis::assumed, "Velocity gradient, row i: du_i/dx, du_i/dy, du_i/dz."},
           {"amplitude", &amplitude, "m/s", -1e3, 1e3, Basis::assumed, "Amplitude of the oscillating part."},
           renamed({"angular_frequency", &omega, "rad/s", 0, 1e6, Basis::assumed, "Angular frequency of the oscillating part."},
                   {.key = "omega", .unit = "1/s"}),
           {"phase", &phase, "rad", -10, 10, Basis::assumed, "Phase of the oscillating part at t = 0."},
           {"turbulent_kinetic_energy", &turbulent_kinetic_energy, "m2/s2", 0, 1e4, Basis::assumed,
            "Turbulent kinetic energy k at the origin, in addition to the flow of the formula."},
           {"turbulent_kinetic_energy_gradient", &turbulent_kinetic_energy_gradient, "m/s2", -1e4, 1e4, Basis::assumed,
            "Gradient of k; k is zero where it would be negative."},
           {"dissipation_rate", &dissipation_rate, "m2/s3", 0, 1e6, Basis::assumed, "Dissipation rate epsilon of this turbulence."}}};
}
const bool prescribed_flow_table = add_case_table<PrescribedFlow>(120);

double PrescribedFlow::viscosity() const {
  if (dynamic_viscosity && kinematic_viscosity)
    throw Error(ExitCode::usage, "[flow]: dynamic_viscosity and kinematic_viscosity are both given; leave one of them out");
  if (kinematic_viscosity) return *kinematic_viscosity * density;
  return dynamic_viscosity.value_or(water_viscosity);
}

void PrescribedFlow::check_divergence() const {
  const double divergence = gradient[0].x + gradient[1].y + gradient[2].z;
  const double size = std::sqrt(norm_squared(gradient[0]) + norm_squared(gradient[1]) + norm_squared(gradient[2]));
  if (std::abs(divergence) > rounding_of_divergence * size)
    throw Error(ExitCode::usage, "[flow]: gradient_per_s has the sum of du/dx, dv/dy and dw/dz (" + rounded(divergence) +
                                     " 1/s), must be zero: water keeps its volume; take a third of the sum from each of them");
}

PrescribedField::PrescribedField(const PrescribedFlow& flow) : flow_(flow), viscosity_(flow.viscosity()) { flow.check_divergence(); }

void PrescribedField::sample(std::span<const Tile> tiles, const SampleSet& needed) {
  needed_ = needed;
  arrays_.fit(tiles, n_arrays());
  // What is the same everywhere and always.
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const auto fill = [&](int field, double value) { std::fill_n(arrays_.field(t, field), tiles[t].exists.size(), value); };
    for (int i = 0; i < 9 && needed.velocity_gradient; ++i) fill(gradient + i, flow_.gradient[i / 3][i % 3]);
  }
}

Vec3 PrescribedField::uniform_velocity(double t) const {
  Vec3 u = flow_.velocity;
  for (int i = 0; i < 3; ++i)
    if (flow_.amplitude[i] != 0) u[i] += flow_.amplitude[i] * std::sin(flow_.omega[i] * t + flow_.phase[i]);
  return u;
}

Vec3 PrescribedField::uniform_rate(double t) const {
  Vec3 rate;
  for (int i = 0; i < 3; ++i)
    if (flow_.amplitude[i] != 0) rate[i] = flow_.amplitude[i] * flow_.omega[i] * std::cos(flow_.omega[i] * t + flow_.phase[i]);
  return rate;
}

void PrescribedField::set_velocity(const VectorSum& u_at, const Tile& tile, double t, double ago) const {
  const double *x = tile.field(Tile::x), *y = tile.field(Tile::y), *z = tile.field(Tile::z);
  const double *v_x = tile.field(Tile::vx), *v_y = tile.field(Tile::vy), *v_z = tile.field(Tile::vz);
  const Vec3 uniform = uniform_velocity(t);
  const Mat3 G = flow_.gradient;
  const int begin = tile.index(0, 0), end = tile.index(tile.nx, tile.ny - 1);
#pragma omp simd
  for (int p = begin; p < end; ++p) {
    const Vec3 u = uniform + G * Vec3{x[p] - ago * v_x[p], y[p] - ago * v_y[p], z[p] - ago * v_z[p]};
    u_at.x[p] = u.x, u_at.y[p] = u.y, u_at.z[p] = u.z;
  }
  if (!flow_.pipe.changes_water()) return;
  const double speed = flow_.pipe_speed();
  for (int p = begin; p < end; ++p) u_at.add(p, flow_.pipe.velocity(tile.vector(Tile::x, p) - ago * tile.vector(Tile::vx, p), speed));
}

void PrescribedField::set_gradient(const std::array<VectorSum, 3>& G_at, const Tile& tile) const {
  const int begin = tile.index(0, 0), end = tile.index(tile.nx, tile.ny - 1);
  const double speed = flow_.pipe_speed();
  for (int p = begin; p < end; ++p) {
    const Mat3 G = flow_.pipe.gradient(tile.vector(Tile::x, p), speed);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 row = flow_.gradient[i] + G[i];
      G_at.at(i).x[p] = row.x, G_at.at(i).y[p] = row.y, G_at.at(i).z[p] = row.z;
    }
  }
}

FluidSamples PrescribedField::at(std::size_t index, const Tile& tile, double elapsed, double step) {
  const double start = time_ + elapsed, middle = start + 0.5 * step;
  const auto vector = [&](int f) { return VectorSum{arrays_.field(index, f), arrays_.field(index, f + 1), arrays_.field(index, f + 2)}; };
  const VectorSum u_0 = vector(velocity), u_m = vector(change);
  const std::array G_at{vector(gradient), vector(gradient + 3), vector(gradient + 6)};
  set_velocity(u_0, tile, start, 0.5 * step), set_velocity(u_m, tile, middle, 0);
  if (flow_.pipe.changes_water() && needed_.velocity_gradient) set_gradient(G_at, tile);
  const auto array = [](const VectorSum& v) { return VectorArray{v.x, v.y, v.z}; };
  FluidSamples fluid{.density = flow_.density,
                     .dynamic_viscosity = viscosity_,
                     .velocity = array(u_0),
                     .velocity_rate = array(u_m),
                     .velocity_gradient = {array(G_at[0]), array(G_at[1]), array(G_at[2])}};
  const int begin = tile.index(0, 0), end = tile.index(tile.nx, tile.ny - 1);
  const FormulaSource source{.flow = flow_,
                             .rate = uniform_rate(middle),
                             .position = {tile.field(Tile::x), tile.field(Tile::y), tile.field(Tile::z)},
                             .velocity = array(u_m),
                             .begin = begin,
                             .end = end};
  for_each_row([&](const SampleRow& row, int first) {
    double* arrays[3] = {};
    for (int i = 0; i < row.components(); ++i) arrays[i] = arrays_.field(index, first + i);
    if (row.of_formula && needed_.*row.needed) row.of_formula(source, arrays);
    row.point(fluid, arrays);
  });
  const double per_half = step > 0 ? 2 / step : 0;
#pragma omp simd
  for (int p = begin; p < end; ++p)
    u_m.x[p] = per_half * (u_m.x[p] - u_0.x[p]), u_m.y[p] = per_half * (u_m.y[p] - u_0.y[p]), u_m.z[p] = per_half * (u_m.z[p] - u_0.z[p]);
  return fluid;
}

}  // namespace snag
