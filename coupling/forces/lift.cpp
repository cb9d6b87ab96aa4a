// Lift of a sphere in a shear, and of one that spins:
//
//   shear:  F = theta C 1.615 d^2 (rho mu/|omega|)^(1/2) w x omega,   w = u - v,  omega = curl u
//     form "saffman"  C = 1
//     form "mei"      C = (1 - 0.3314 a^(1/2)) exp(-Re/10) + 0.3314 a^(1/2)   Re <= 40,    a = |omega| d/(2 |w|), at most 0.4
//                         0.0524 (a Re)^(1/2)                                 Re > 40
//     form "mei_free"  as mei, of a sphere that turns as freely as the water lets it, omega_p = omega/2
//   spin:   F = theta pi/8 rho d^3 (omega_p - omega/2) x (v - u)
//
// The slope grows by |F|/|w|, so that a lift larger than the inertia of a sub-step cannot make it unstable.
// Source: Saffman (1965), J. Fluid Mech. 22, 385, with corrigendum 31, 624; Mei (1992), Int. J. Multiphase Flow 18, 145-147; Rubinow and
// Keller (1961), J. Fluid Mech. 11, 447-459.
#include <algorithm>
#include <numbers>

#include "coupling/fluid_force.hpp"
#include "coupling/vector_math.hpp"

namespace snag {
namespace {

constexpr double tiny = 1e-30;

struct Lift final : FluidForce {
  static constexpr const char* name = "lift";
  double coefficient = 1, rotation_coefficient = 1;
  enum class Form { mei, saffman, mei_free };
  Choice<Form> form{Form::mei, {"mei", "saffman", "mei_free"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = theta (1.615 C d^2 (rho mu/|omega|)^(1/2) w x omega + pi/8 rho d^3 (omega_p - omega/2) x (v - u))",
            .source = "Saffman (1965), Mei (1992), Rubinow and Keller (1961)",
            .valid_for = "spheres away from walls; saffman Re < 1, mei Re < 100",
            .samples = {.velocity_gradient = true},
            .prior = Prior{.key = "coupling.lift.coefficient",
                           .meaning = "factor on shear and spin lift",
                           .mean = 1,
                           .sd = 0.5,
                           .minimum = 0,
                           .maximum = 10,
                           .needs = {Need::gradient}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"coefficient", &coefficient, "1", 0, 100, Basis::literature, "Factor theta on the lift; 1 by theory."},
            {"rotation_coefficient", &rotation_coefficient, "1", 0, 10, Basis::literature, "Further factor on the lift by spin."},
            setting("form", &form, "saffman: creeping flow; mei: with its decay at finite Re; mei_free: as mei, without lift by spin.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double rho = fluid.density, mu = fluid.dynamic_viscosity, d = particles.diameter, mei = form == Form::saffman ? 0 : 1;
    const double shear = coefficient * 1.615 * d * d * std::sqrt(rho * mu);
    const double spin = form == Form::mei_free ? 0 : coefficient * rotation_coefficient * std::numbers::pi / 8 * rho * d * d * d;
    const VectorArray u = fluid.velocity, v = particles.velocity, omega_p = particles.angular_velocity;
    const auto G = fluid.velocity_gradient;
    const VectorSum force = forces.force;
    double* slope = forces.slope;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 w = u[p] - v[p];
      const Vec3 omega{G[2].y[p] - G[1].z[p], G[0].z[p] - G[2].x[p], G[1].x[p] - G[0].y[p]};
      const double speed = std::sqrt(norm_squared(w)), turn = std::sqrt(norm_squared(omega));
      const double Re = rho * speed * d / mu, a = std::min(0.5 * turn * d / (speed + tiny), 0.4), root = 0.3314 * std::sqrt(a);
      const double slow = (1 - root) * exp(-0.1 * Re) + root, fast = 0.0524 * std::sqrt(a * Re);
      const double C = 1 + mei * ((Re <= 40 ? slow : fast) - 1);
      const double S = shear * C / std::sqrt(turn + tiny);
      const Vec3 turning = S * omega + spin * (omega_p[p] - 0.5 * omega);
      const Vec3 F = cross(w, turning);
      force.x[p] += F.x, force.y[p] += F.y, force.z[p] += F.z;
      slope[p] += std::sqrt(norm_squared(turning));
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    // Re = 1e-3, so that Mei's factor is that of Saffman's to 2e-4; a sphere ahead of a shear u_x = G y is drawn to the slow side.
    SphereState shear = stokes_limit().state;
    const double d = shear.diameter, rho = shear.fluid_density, mu = shear.dynamic_viscosity, speed = 1e-3 * mu / (rho * d);
    const double G = 1e-8 * speed / d;
    shear.velocity = {speed, 0, 0};
    shear.velocity_gradient[0] = {0, G, 0};
    shear.angular_velocity = {0, 0, -0.5 * G};
    SphereState spin = shear;
    spin.velocity_gradient = {};
    spin.angular_velocity = {0, 0, 5};
    const double r = d / 2;
    return {{.what = "sphere ahead of a shear",
             .source = "Saffman (1965): 6.46 mu r^2 V (G/nu)^(1/2)",
             .state = shear,
             .force = {0, -6.46 * mu * r * r * speed * std::sqrt(G * rho / mu), 0},
             .tolerance = 1e-3},
            {.what = "spinning sphere in still water",
             .source = "Rubinow and Keller (1961): pi rho r^3 omega x V",
             .state = spin,
             .force = {0, std::numbers::pi * rho * r * r * r * 5 * speed, 0},
             .tolerance = 1e-12}};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Lift>();

}  // namespace
}  // namespace snag
