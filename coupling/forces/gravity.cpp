// Weight and buoyancy:   F = (m - rho V_h) g,   V_h: the volume of water that the particle displaces.
//
// The pressure of the solver is the one beside the hydrostatic, so the water's own weight is in no equation. What the displaced water would
// have weighed is carried by the hydrostatic pressure: the flow does not feel this force.
// Source: Archimedes.
#include <numbers>

#include "coupling/fluid_force.hpp"

namespace snag {
namespace {

struct Gravity final : FluidForce {
  static constexpr const char* name = "gravity";
  Vec3 acceleration{0, 0, -9.81};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = (m - rho V_h) g",
            .source = "Archimedes",
            .valid_for = "fluid of uniform density",
            .reacts_on_fluid = false,
            .role = Role::weight,
            .prior = Prior{.key = "gravity.acceleration_m_s2",
                           .meaning = "weight and buoyancy, in units of 9.81 m/s2: the vector is (0, 0, -9.81 theta)",
                           .mean = 1,
                           .sd = 0.05,
                           .minimum = 0,
                           .maximum = 2}};
  }
  std::vector<Parameter> parameters() override {
    return {{"acceleration", &acceleration, "m/s2", -1000, 1000, Basis::literature, "g; weight and buoyancy act where it is given."}};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const Vec3 F = (particles.mass - fluid.density * particles.volume) * acceleration;
    for (int p = particles.begin; p < particles.end; ++p) forces.force.add(p, F);
  }
  std::vector<ReferenceCase> reference_cases() const override {
    SphereState afloat;
    afloat.particle_density = afloat.fluid_density;
    afloat.velocity = {1, 2, 3};
    SphereState heavy;
    heavy.diameter = 0.1, heavy.fluid_density = 1000, heavy.particle_density = 3000;
    const double displaced = std::numbers::pi / 6 * 1e-3 * 1000;  // kg
    return {{.what = "neutrally buoyant sphere", .source = "Archimedes", .state = afloat, .force = {}, .tolerance = 1e-12},
            {.what = "sphere three times as dense as water",
             .source = "Archimedes",
             .state = heavy,
             .force = {0, 0, -2 * displaced * 9.81},
             .tolerance = 1e-12}};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Gravity>();

}  // namespace
}  // namespace snag
