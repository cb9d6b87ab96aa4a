// Turbulence that the mean flow does not resolve, as the particle sees it:   u -> u + theta sigma q,   sigma = (2 k/3)^(1/2)
//
//   dq = -q dt/T + theta grad(sigma) dt/(1 + St) + (2/T)^(1/2) dW,   St = tau/T,  tau = m/(3 pi mu d)        normalised Langevin equation
//   q(t + h) = e q + (1 - e) T theta grad(sigma)/(1 + St) + (1 - e^2)^(1/2) N(0, 1),   e = exp(-h/T)          exact for T and sigma
//   constant
//
//   form "lagrangian"   T = C_T k/epsilon
//   form "crossing"     T = C_T k/epsilon/(1 + (|w|/sigma)^2)^(1/2): a particle that falls through the eddies leaves them sooner
//   form "eddy"         q is drawn anew after each eddy lifetime of 2 T, and stays in between, without drift by inhomogeneous turbulence
//
// The drift keeps tracers well mixed where k varies: without it they gather where the turbulence is weak. Random numbers are counted by
// particle, so that a run does not depend on ranks, and a resumed one goes on as it would have. Particles of one cloth are moved
// independently of each other: eddies larger than the spacing are not correlated.
// Source: Thomson (1987), J. Fluid Mech. 180, 529-556; Bocksell and Loth (2006), Int. J. Multiphase Flow 32, 1234-1253 (inertia); Csanady
// (1963), J. Atmos. Sci. 20, 201-208; Gosman and Ioannides (1983), J. Energy 7, 482-490 (eddies).
#include <algorithm>
#include <numbers>

#include "base/random_numbers.hpp"
#include "coupling/fluid_force.hpp"
#include "dem/particles/tile_particles.hpp"

namespace snag {
namespace {

constexpr double tiny = 1e-300;

struct TurbulentDispersion final : FluidForce {
  static constexpr const char* name = "turbulent_dispersion";
  enum State { number, q_x, q_y, q_z, age, n_particle_state };
  double intensity = 1, time_constant = 0.3;
  int seed = 1;
  enum class Form { lagrangian, crossing, eddy };
  Choice<Form> form{Form::lagrangian, {"lagrangian", "crossing", "eddy"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "u -> u + theta sigma q, dq = -q dt/T + theta grad(sigma) dt/(1 + St) + (2/T)^(1/2) dW, T = C_T k/epsilon",
            .source = "Thomson (1987), Bocksell and Loth (2006)",
            .valid_for = "isotropic turbulence given by k and epsilon; particles smaller than the eddies",
            .samples = {.turbulence = true},
            .role = Role::fluid,
            .n_particle_state = n_particle_state,
            .prior = Prior{.key = "coupling.turbulent_dispersion.intensity",
                           .meaning = "rms fluctuation over that by k",
                           .mean = 1,
                           .sd = 0.5,
                           .minimum = 0,
                           .maximum = 5,
                           .random = true,
                           .needs = {Need::turbulence}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"intensity", &intensity, "1", 0, 10, Basis::literature, "Factor theta on the fluctuations; 1: those of k, 0: none."},
            {"time_constant", &time_constant, "1", 1e-3, 10, Basis::literature, "C_T; published values from 0.15 to 0.6."},
            {.key = "seed", .target = &seed, .minimum = 0, .meaning = "Seed of the random numbers; each seed gives another realisation."},
            setting("form", &form, "Correlation in time: lagrangian, crossing (of trajectories), or eddy (constant for a lifetime).")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (intensity == 0) return;
    const double tau = particles.mass / (3 * std::numbers::pi * fluid.dynamic_viscosity * particles.diameter);
    const bool eddy = form == Form::eddy, crossing = form == Form::crossing;
    const auto at = [&](int i, int p) -> double& { return particles.state[i * particles.state_stride + p]; };
    for_particles(particles.tile, [&](int p, int column, int row) {
      const double k = fluid.turbulent_kinetic_energy[p], sigma = std::sqrt(2.0 / 3 * k);
      const Vec3 w = fluid.velocity[p] - particles.velocity[p];
      double T = time_constant * k / (fluid.dissipation_rate[p] + tiny);
      if (crossing) T /= std::sqrt(1 + norm_squared(w) / (sigma * sigma + tiny));
      T = std::max(T, 1e-6 * particles.step);
      Vec3 q{at(q_x, p), at(q_y, p), at(q_z, p)};
      const bool first = at(number, p) == 0;
      const auto draw = [&] {
        return normal_numbers(static_cast<std::uint64_t>(seed), particles.id(column, row), static_cast<std::uint64_t>(at(number, p)++));
      };
      if (first) {
        q = draw();
      } else if (eddy) {
        at(age, p) += particles.step;
        if (at(age, p) >= 2 * T) q = draw(), at(age, p) = 0;
      } else {
        const double e = std::exp(-particles.step / T);
        // grad sigma = grad k/(3 sigma)
        const Vec3 drift = intensity * T / (1 + tau / T) / (3 * sigma + tiny) * fluid.turbulent_kinetic_energy_gradient[p];
        q = e * q + (1 - e) * drift + std::sqrt(1 - e * e) * draw();
      }
      at(q_x, p) = q.x, at(q_y, p) = q.y, at(q_z, p) = q.z;
      forces.fluid_velocity.add(p, intensity * sigma * q);
    });
  }
  std::vector<ReferenceCase> reference_cases() const override {
    auto calm = drag_at(100, 1.087, 0.02, "standard drag curve, Clift, Grace and Weber (1978)");
    calm.what = "no turbulence, no change";
    return {calm};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<TurbulentDispersion>();

}  // namespace
}  // namespace snag
