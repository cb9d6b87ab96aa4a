// Stresses of the undisturbed flow:   F = theta V_h (-grad p + div tau),   p beside the hydrostatic pressure
//
//   form "acceleration"     -grad p + div tau = rho Du/Dt: with the viscous stress, by the momentum equation of the water
//   form "pressure"         -grad p alone
//   form "along_particle"   rho du/dt along the way of the particle, du/dt = Du/Dt - (w . grad) u, w = u - v: as in the older literature
//
// The water does not feel the opposite force. In this solver it fills the whole volume, that of the particles too, so that its inertia
// there, rho V_h Du/Dt, is in its equation already. With the drag F_d alone as reaction, water and particles of solid fraction phi sum to
//
//   rho Du/Dt = -grad p - n F_d,   m dv/dt = rho V_h Du/Dt + F_d    =>   (1 - phi) rho Du/Dt + phi rho_p dv/dt = -grad p
//
// which is the momentum of the mixture (n: particles per volume, phi = n V_h); a reaction would count phi rho Du/Dt twice.
//
// Source: Maxey and Riley (1983), Phys. Fluids 26, 883-889; along_particle: Tchen (1947).
#include <numbers>

#include "coupling/fluid_force.hpp"

namespace snag {
namespace {

struct PressureGradient final : FluidForce {
  static constexpr const char* name = "pressure_gradient";
  double coefficient = 1;
  enum class Form { acceleration, pressure, along_particle };
  Choice<Form> form{Form::acceleration, {"acceleration", "pressure", "along_particle"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = theta V_h (-grad p + div tau) = theta rho V_h Du/Dt",
            .source = "Maxey and Riley (1983)",
            .valid_for = "particles smaller than the scale over which the acceleration of the fluid varies",
            .reacts_on_fluid = false,
            .samples = {.velocity_gradient = form == Form::along_particle,
                        .pressure_gradient = form == Form::pressure,
                        .material_acceleration = form != Form::pressure},
            .prior = Prior{.key = "coupling.pressure_gradient.coefficient",
                           .meaning = "share of the stress of the undisturbed flow",
                           .mean = 1,
                           .sd = 0.4,
                           .minimum = 0,
                           .maximum = 3,
                           .exclusive_forms = true}};  // statements of which acceleration acts, no approximations of one law
  }
  std::vector<Parameter> parameters() override {
    return {{"coefficient", &coefficient, "1", 0, 10, Basis::literature, "Factor theta on the force; 1 by theory."},
            setting("form", &form, "acceleration: rho Du/Dt; pressure: without the viscous stress; along_particle: rho du/dt on its way.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const bool pressure = form == Form::pressure, along = form == Form::along_particle;
    const double factor = coefficient * particles.volume * (pressure ? -1 : fluid.density);
    const VectorArray a = pressure ? fluid.pressure_gradient : fluid.material_acceleration, u = fluid.velocity, v = particles.velocity;
    const VectorSum force = forces.force;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p)
      force.x[p] += factor * a.x[p], force.y[p] += factor * a.y[p], force.z[p] += factor * a.z[p];
    if (!along) return;
    const auto G = fluid.velocity_gradient;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 w = u[p] - v[p];
      force.x[p] -= factor * dot(G[0][p], w), force.y[p] -= factor * dot(G[1][p], w), force.z[p] -= factor * dot(G[2][p], w);
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    SphereState state;
    state.fluid_density = 1000, state.diameter = 0.1, state.material_acceleration = {3, 0, -4};
    state.pressure_gradient = -1000 * state.material_acceleration;
    const double displaced = std::numbers::pi / 6 * 1e-3 * 1000;  // kg
    return {{.what = "accelerating water carries a sphere like the water that it displaces",
             .source = "Archimedes, in the frame of the water",
             .state = state,
             .force = displaced * state.material_acceleration,
             .tolerance = 1e-12}};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<PressureGradient>();

}  // namespace
}  // namespace snag
