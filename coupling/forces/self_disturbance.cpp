// The water that a kernel averages holds the wake of the particle itself; its drag wants the water without:
//
//   u -> u + theta c/(1 - c) (u - v),   c = f d/(2 pi^(1/2) delta) psi
//   psi = 1/(1 + 0.72 Re_delta),   Re_delta = rho |w| delta/mu
//
// c w is what a force f 3 pi mu d w, spread by a Gaussian of width delta over water that moves on with w, leaves in the average by the same
// Gaussian: in creeping flow F/(6 pi^(3/2) mu delta); psi is the steady Oseen solution, averaged in the same way, to 3 %. f = 1 + 0.15
// Re^0.687 stands for the drag law. delta^2 = (kernel width)^2 + (0.25 cell size)^2: the answer of a single cell to its own force. For
// particles apart from each other, in water that has had the time delta^2/nu; c counts as at most 0.8. In a prescribed flow and one-way
// there is nothing to correct.
// Source: Stokes and Oseen flow by Fourier transform; in the manner of Balachandar, Liu and Lakhote (2019), J. Comput. Phys. 376, 160-185,
// and Evrard, Denner and van Wachem (2020), Int. J. Multiphase Flow 132, 103535.
#include <algorithm>
#include <numbers>

#include "coupling/fluid_force.hpp"
#include "coupling/vector_math.hpp"

namespace snag {
namespace {

struct SelfDisturbance final : FluidForce {
  static constexpr const char* name = "self_disturbance";
  double strength = 1;

  ForceDescription description() const override {
    return {.name = name,
            .equation = "u -> u + theta c/(1 - c) (u - v), c = f d/(2 pi^(1/2) delta (1 + 0.72 Re_delta))",
            .source = "steady Oseen flow about a Gaussian force; Balachandar, Liu and Lakhote (2019)",
            .valid_for = "two-way coupled particles that are several kernel widths apart",
            .samples = {.disturbance = true},
            .role = Role::fluid,
            .prior = Prior{.key = "coupling.self_disturbance.strength",
                           .meaning = "share of the particle's own disturbance that is taken off",
                           .mean = 1,
                           .sd = 0.5,
                           .minimum = 0,
                           .maximum = 2,
                           .acts_on_water = true}};
  }
  std::vector<Parameter> parameters() override {
    return {{"strength", &strength, "1", 0, 2, Basis::literature, "Strength theta of the correction; 1 by theory, 0: no correction."}};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (strength == 0) return;
    const double rho = fluid.density, mu = fluid.dynamic_viscosity, d = particles.diameter, theta = strength;
    const VectorArray u = fluid.velocity, v = particles.velocity;
    const VectorSum seen = forces.fluid_velocity;
    const double* width = fluid.disturbance_width;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 sampled = u[p] - v[p];
      const double speed = std::sqrt(norm_squared(sampled)), delta = width[p];
      double growth = 1;  // undisturbed over sampled slip, by repeated insertion
      for (int i = 0; i < 4; ++i) {
        const double per_mu = rho * growth * speed / mu;
        const double c = (1 + 0.15 * pow(per_mu * d, 0.687)) * d / (2 * std::sqrt(std::numbers::pi) * delta * (1 + 0.72 * per_mu * delta));
        growth = 1 / (1 - std::min(c, 0.8));
      }
      const double more = theta * (growth - 1);
      seen.x[p] += more * sampled.x, seen.y[p] += more * sampled.y, seen.z[p] += more * sampled.z;
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    auto wide = stokes_limit();
    wide.what = "kernel ten thousand times the sphere: nothing to correct";
    wide.state.disturbance_width = 1e4 * wide.state.diameter;
    auto narrow = stokes_limit();
    narrow.what = "kernel as wide as the sphere, creeping flow";
    narrow.source = "Gaussian Stokeslet averaged by the same Gaussian: F/(6 pi^(3/2) mu delta)";
    narrow.state.disturbance_width = narrow.state.diameter;
    narrow.force = 1 / (1 - 0.5 / std::sqrt(std::numbers::pi)) * narrow.force, narrow.tolerance = 1e-3;
    return {wide, narrow};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<SelfDisturbance>();

}  // namespace
}  // namespace snag
