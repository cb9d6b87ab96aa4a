// Torque on a sphere in a fluid that turns otherwise:   T = theta C pi mu d^3 (omega/2 - omega_p),   omega = curl u
//
//   form "stokes"   C = 1
//   form "dennis"   C = max(1, (12.9 Re_r^(1/2) + 128.4)/(64 pi)),   Re_r = rho |omega/2 - omega_p| d^2/mu
//
// Implicit in the spin. Only forces are spread to the water: it does not feel the opposite couple. Source: Kirchhoff (1876); Dennis, Singh
// and Ingham (1980), J. Fluid Mech. 101, 257-279: T = 1/2 rho r^5 Omega^2 C_T, C_T = 12.9/Re_r^(1/2) + 128.4/Re_r above Re_r = 32.
#include <algorithm>
#include <numbers>

#include "coupling/fluid_force.hpp"

namespace snag {
namespace {

struct Torque final : FluidForce {
  static constexpr const char* name = "torque";
  double coefficient = 1;
  enum class Form { stokes, dennis };
  Choice<Form> form{Form::stokes, {"stokes", "dennis"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "T = theta C pi mu d^3 (omega/2 - omega_p)",
            .source = "Kirchhoff (1876); Dennis, Singh and Ingham (1980)",
            .valid_for = "spheres; stokes Re_r < 32, dennis Re_r < 1000",
            .reacts_on_fluid = false,
            .samples = {.velocity_gradient = true},
            .gives_torque = true,
            .prior = Prior{.key = "coupling.torque.coefficient",
                           .meaning = "factor on the torque",
                           .mean = 1,
                           .sd = 0.5,
                           .minimum = 0,
                           .maximum = 10,
                           .needs = {Need::gradient, Need::bonds}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"coefficient", &coefficient, "1", 0, 100, Basis::literature, "Factor theta on the torque; 1 by theory."},
            setting("form", &form, "stokes: creeping flow; dennis: more at finite Re.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double d = particles.diameter, mu = fluid.dynamic_viscosity, dennis = form == Form::dennis ? 1 : 0;
    const double K_stokes = coefficient * std::numbers::pi * mu * d * d * d, per_turn = fluid.density * d * d / mu;
    const VectorArray omega_p = particles.angular_velocity;
    const auto G = fluid.velocity_gradient;
    const VectorSum torque = forces.torque;
    double* slope = forces.torque_slope;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 half{0.5 * (G[2].y[p] - G[1].z[p]), 0.5 * (G[0].z[p] - G[2].x[p]), 0.5 * (G[1].x[p] - G[0].y[p])};
      const Vec3 turn = half - omega_p[p];
      const double Re = per_turn * std::sqrt(norm_squared(turn));
      // 1/2 rho r^5 Omega^2 C_T over 8 pi mu r^3 Omega = Re C_T/(64 pi)
      const double finite = std::max(1.0, (12.9 * std::sqrt(Re) + 128.4) / (64 * std::numbers::pi));
      const double K = K_stokes * (1 + dennis * (finite - 1));
      torque.x[p] += K * turn.x, torque.y[p] += K * turn.y, torque.z[p] += K * turn.z;
      slope[p] += K;
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    SphereState still;
    still.angular_velocity = {0, 0, 2};
    const double r = still.diameter / 2;
    const Vec3 T{0, 0, -8 * std::numbers::pi * still.dynamic_viscosity * r * r * r * 2};
    return {{.what = "spinning sphere in still water",
             .source = "Kirchhoff (1876): 8 pi mu r^3 omega",
             .state = still,
             .force = {},
             .tolerance = 1e-12,
             .torque = T}};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Torque>();

}  // namespace
}  // namespace snag
