// History (Basset) force, from the diffusion of the boundary layer of all accelerations before:
//
//   F = theta B int_0^t K(t - tau) d(u - v)/dtau dtau,   B = 3/2 d^2 (pi rho mu)^(1/2)
//     form "basset"   K(t) = t^(-1/2)
//     form "fading"   K(t) = t^(-1/2) exp(-t/t_w): at finite Re the memory fades faster, as the layer is carried away
//     form "developed"  K of basset; the slip at the start has been there for long
//
// Else a slip at the start counts as set in motion then: B (u - v)_0 K(t). The kernel is a sum of exponentials: the trapezoidal rule for
//   t^(-1/2) = pi^(-1/2) int exp(y/2 - t exp(y)) dy = sum_i a_i exp(-s_i t),   s_i = s_max exp(-i D),  a_i = D (s_i/pi)^(1/2)
// whose error with D = 1.2 is 5e-4 for t from 1e-6 s to 30 s; rates below the last are one constant. So a particle remembers 18 vectors
// however long it has moved, and each sub-step costs the same. With the mean over the sub-step h of what was before,
//   F = theta B (sum_i a_i m_i H_i + 4/3 h^(1/2) d(u - v)/dt),   m_i = (1 - exp(-s_i h))/(s_i h)
//   H_i(t + h) = exp(-s_i h) H_i(t) + m_i (w(t + h) - w(t)),   w = u - v,   du/dt = Du/Dt - (w . grad) u
// the acceleration of the present sub-step is implicit, as an added mass: no step is too long.
// Source: Basset (1888); Maxey and Riley (1983), Phys. Fluids 26, 883-889, with the term of the first slip by Maxey (1993); sums of
// exponentials: van Hinsberg, ten Thije Boonkkamp and Clercx (2011), J. Comput. Phys. 230, 1465-1478; fading: Mei and Adrian (1992),
// J. Fluid Mech. 237, 323-341 (there as a power of t).
#include <array>
#include <cmath>
#include <numbers>

#include "coupling/fluid_force.hpp"

namespace snag {
namespace {

constexpr int n_rates = 18;
constexpr double spacing = 1.2, fastest = 1e7;  // D; s_max, 1/s

/// s_i and a_i; the last is the constant.
struct Exponentials {
  Exponentials() {
    for (int i = 0; i < n_rates; ++i) {
      rate[i] = fastest * std::exp(-spacing * i);
      factor[i] = spacing * std::sqrt(rate[i] / std::numbers::pi);
    }
    const double rest = rate[n_rates - 1] * std::exp(-0.5 * spacing);  // int of pi^(-1/2) s^(-1/2) ds from 0
    rate[n_rates] = 0, factor[n_rates] = 2 * std::sqrt(rest / std::numbers::pi);
  }
  std::array<double, n_rates + 1> rate, factor;
};
const Exponentials exponentials;

/// exp(-s h) and its mean over h.
struct Decay {
  double end, mean;
};
Decay decay(double s, double h) {
  const double x = s * h;
  return {std::exp(-x), x < 1e-8 ? 1 - 0.5 * x : -std::expm1(-x) / x};
}

struct History final : FluidForce {
  static constexpr const char* name = "history";
  enum State { last_step, last_w, sums = 4, n_particle_state = sums + 3 * (n_rates + 1) };
  double coefficient = 1, window = 0.1;
  enum class Form { basset, fading, developed };
  Choice<Form> form{Form::basset, {"basset", "fading", "developed"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = theta 3/2 d^2 (pi rho mu)^(1/2) int K(t - tau) d(u - v)/dtau dtau, K = t^(-1/2)",
            .source = "Basset (1888), Maxey and Riley (1983), van Hinsberg et al. (2011)",
            .valid_for = "spheres, Re < 1; basset overestimates long memories at larger Re; sub-steps above 1e-5 s",
            .samples = {.velocity_gradient = true, .material_acceleration = true},
            .gives_added_mass = coefficient > 0,
            .n_particle_state = n_particle_state,
            .prior = Prior{.key = "coupling.history.coefficient",
                           .meaning = "factor on the history force",
                           .mean = 1,
                           .sd = 0.5,
                           .minimum = 0,
                           .maximum = 5}};
  }
  std::vector<Parameter> parameters() override {
    return {
        {"coefficient", &coefficient, "1", 0, 10, Basis::literature, "Factor theta on the history force; 1 by theory."},
        {"window", &window, "s", 1e-6, 1e6, Basis::assumed, "Time window t_w of the form fading."},
        setting("form", &form, "basset: memory as t^(-1/2); fading: lost after t_w; developed: as basset, the slip at the start not new.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (coefficient == 0) return;
    const double d = particles.diameter, h = particles.step;
    const double B = coefficient * 1.5 * d * d * std::sqrt(std::numbers::pi * fluid.density * fluid.dynamic_viscosity);
    advance(fluid, particles);
    const VectorArray u = fluid.velocity, v = particles.velocity, acceleration = fluid.material_acceleration;
    const auto G = fluid.velocity_gradient;
    const VectorSum force = forces.force;
    double *added_mass = forces.added_mass, *step = number(particles, last_step);
    const double m = B * 4.0 / 3 * std::sqrt(h);
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 w = u[p] - v[p];
      force.x[p] += m * (acceleration.x[p] - dot(G[0][p], w));
      force.y[p] += m * (acceleration.y[p] - dot(G[1][p], w));
      force.z[p] += m * (acceleration.z[p] - dot(G[2][p], w));
      added_mass[p] += m;
      step[p] = h;
    }
    for (int i = 0; i <= n_rates; ++i) {
      const double factor = B * exponentials.factor[i] * decay(rate(i), h).mean;
      const VectorSum H = vector(particles, sums + 3 * i);
#pragma omp simd
      for (int p = particles.begin; p < particles.end; ++p)
        force.x[p] += factor * H.x[p], force.y[p] += factor * H.y[p], force.z[p] += factor * H.z[p];
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    // At the first sub-step the slip has just begun: the mean of B w t^(-1/2) over h.
    auto start = stokes_limit();
    const double d = start.state.diameter, h = start.state.step;
    const Vec3 w = start.state.fluid_velocity - start.state.velocity;
    start.what = "impulsive start, mean over the first sub-step";
    start.source = "Basset (1888): 6 a^2 (pi rho mu)^(1/2) w t^(-1/2)";
    start.force =
        1.5 * d * d * std::sqrt(std::numbers::pi * start.state.fluid_density * start.state.dynamic_viscosity) * 2 / std::sqrt(h) * w;
    start.tolerance = 0.01;
    return {start};
  }

 private:
  double rate(int i) const { return exponentials.rate[i] + (form == Form::fading ? 1 / window : 0); }
  static double* number(const Particles& particles, int i) { return particles.state + i * particles.state_stride; }
  static VectorSum vector(const Particles& particles, int i) {
    return {number(particles, i), number(particles, i + 1), number(particles, i + 2)};
  }

  /// Takes the change of slip since the last sub-step into the sums.
  void advance(const FluidSamples& fluid, const Particles& particles) const {
    const Tile& tile = particles.tile;
    int first = particles.begin;
    while (first + 1 < particles.end && tile.exists[static_cast<std::size_t>(first)] < 0.5) ++first;
    const double h = number(particles, last_step)[first];  // the same for a whole tile; 0 at birth
    const bool takes_change = h > 0 || form != Form::developed;
    const VectorArray u = fluid.velocity, v = particles.velocity;
    const VectorSum before = vector(particles, last_w);
    for (int i = 0; i <= n_rates && takes_change; ++i) {
      const Decay past = decay(rate(i), h);
      const VectorSum H = vector(particles, sums + 3 * i);
#pragma omp simd
      for (int p = particles.begin; p < particles.end; ++p) {
        H.x[p] = past.end * H.x[p] + past.mean * (u.x[p] - v.x[p] - before.x[p]);
        H.y[p] = past.end * H.y[p] + past.mean * (u.y[p] - v.y[p] - before.y[p]);
        H.z[p] = past.end * H.z[p] + past.mean * (u.z[p] - v.z[p] - before.z[p]);
      }
    }
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p)
      before.x[p] = u.x[p] - v.x[p], before.y[p] = u.y[p] - v.y[p], before.z[p] = u.z[p] - v.z[p];
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<History>();

}  // namespace
}  // namespace snag
