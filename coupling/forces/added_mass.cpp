// Added mass:   F = C_m rho V_h (Du/Dt - dv/dt)
//
//   form "free"   C_m = theta:  1/2 for a sphere in unbounded fluid
//   form "wall"   C_m = theta (1 + (a/h)^3/4),  a: radius, h: distance of the centre from the nearest wall
//                 (mean over the directions of 3/16 along the wall, twice, and 3/8 towards it)
//
// Implicit: rho V_h C_m joins the mass that is accelerated, so that particles lighter than water are stable.
// Source: Auton, Hunt and Prud'homme (1988), J. Fluid Mech. 197, 241-257; wall: Lamb (1932), Hydrodynamics, section 99.
#include <algorithm>
#include <numbers>

#include "coupling/fluid_force.hpp"

namespace snag {
namespace {

struct AddedMass final : FluidForce {
  static constexpr const char* name = "added_mass";
  double coefficient = 0.5;
  enum class Form { free, wall };
  Choice<Form> form{Form::free, {"free", "wall"}};

  bool at_wall() const { return form == Form::wall; }
  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = C_m rho V_h (Du/Dt - dv/dt)",
            .source = "Auton, Hunt and Prud'homme (1988); near walls Lamb (1932)",
            .valid_for = "particles smaller than the scale over which the acceleration of the fluid varies",
            .samples = {.material_acceleration = true, .wall = at_wall()},
            .gives_added_mass = true,
            .prior = Prior{.key = "coupling.added_mass.coefficient",
                           .meaning = "added-mass coefficient",
                           .mean = 0.5,
                           .sd = 0.25,
                           .minimum = 0,
                           .maximum = 3}};
  }
  std::vector<Parameter> parameters() override {
    return {{"coefficient", &coefficient, "1", 0, 100, Basis::literature, "theta: C_m far from walls; 1/2 for a sphere."},
            setting("form", &form, "free: C_m everywhere; wall: larger near walls.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double m_free = coefficient * fluid.density * particles.volume, a = 0.5 * particles.diameter;
    const VectorArray acceleration = fluid.material_acceleration;
    const VectorSum force = forces.force;
    double* added_mass = forces.added_mass;
    const double* h = at_wall() ? fluid.wall_distance : nullptr;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const double s = h ? a / std::max(h[p], a) : 0;
      const double m = m_free * (1 + 0.25 * s * s * s);
      force.x[p] += m * acceleration.x[p], force.y[p] += m * acceleration.y[p], force.z[p] += m * acceleration.z[p];
      added_mass[p] += m;
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    SphereState state;
    state.fluid_density = 1000, state.diameter = 0.1, state.material_acceleration = {3, 0, -4};
    const double half_displaced = std::numbers::pi / 12 * 1e-3 * 1000;  // kg
    return {{.what = "sphere at rest in accelerating water",
             .source = "Lamb (1932), section 92: half of the displaced mass",
             .state = state,
             .force = half_displaced * state.material_acceleration,
             .tolerance = 1e-12,
             .added_mass = half_displaced}};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<AddedMass>();

}  // namespace
}  // namespace snag
