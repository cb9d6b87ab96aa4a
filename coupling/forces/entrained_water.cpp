// Water held in the cloth and carried with it, theta of the volume V_h of the particle:
//
//   m_w = theta rho V_h joins the mass;   F = m_w Du/Dt, the stress of the undisturbed flow on its volume;   weight and buoyancy cancel
//
// In a flow of uniform density it acts as added mass does: the two differ only by what is known of them beforehand. The default mass of a
// rag is the soaked one (mass_per_area) and holds the water of its own thickness already.
// Source: definition; Newton's second law for cloth and water together.
#include <numbers>

#include "coupling/fluid_force.hpp"

namespace snag {
namespace {

struct EntrainedWater final : FluidForce {
  static constexpr const char* name = "entrained_water";
  double volume_ratio = 0;

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = theta rho V_h (Du/Dt - dv/dt)",
            .source = "Newton's second law for cloth and water together",
            .valid_for = "soaked cloth whose water does not flow through it",
            .samples = {.material_acceleration = true},
            .gives_added_mass = volume_ratio > 0,
            .prior = Prior{.key = "coupling.entrained_water.volume_ratio",
                           .meaning = "water carried along over the volume of the cloth",
                           .mean = 1,
                           .sd = 0.5,
                           .minimum = 0,
                           .maximum = 10,
                           .needs = {Need::bonds}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"volume_ratio", &volume_ratio, "1", 0, 100, Basis::assumed, "theta: volume of the water over V_h."}};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double m = volume_ratio * fluid.density * particles.volume;
    const VectorArray a = fluid.material_acceleration;
    const VectorSum force = forces.force;
    double* added_mass = forces.added_mass;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      force.x[p] += m * a.x[p], force.y[p] += m * a.y[p], force.z[p] += m * a.z[p];
      added_mass[p] += m;
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    return {{.what = "dry cloth carries nothing", .source = "definition", .state = {}, .force = {}, .tolerance = 0, .added_mass = 0}};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<EntrainedWater>();

}  // namespace
}  // namespace snag
