// Drag of a fibre, segment by segment: each particle is a length l = 2 r_p of a cable about the direction t of the row at the particle,
//
//   F = mu l (f_n w_n + f_t w_t),   w_t = (w.t) t,   w_n = w - w_t        f_n: any length, f_t: cable (coupling/cylinder_drag.hpp)
//
// A particle without neighbours in its row counts as a cylinder across the flow. Ends and neighbouring fibres are not felt; in creeping
// flow the drag along the fibre vanishes, which that of a fibre of finite length does not (fibre_drag). Source: Casarella and Choo (1971),
// J. Hydronaut. 5, 3-10 (there with Re_n in both directions).
#include "coupling/cylinder_drag.hpp"
#include "coupling/lattice_directions.hpp"

namespace snag {
namespace {

struct CylinderSegments final : FluidForce {
  static constexpr const char* name = "cylinder_segments";
  double drag_factor = 1;

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = 1/2 mu l (C_n Re_n) w_n + pi mu l (0.55 Re^(1/2) + 0.084 Re^(2/3)) w_t",
            .source = "Casarella and Choo (1971)",
            .valid_for = "fibres, long against their diameter, Re < 1e5",
            .role = Role::drag};
  }
  std::vector<Parameter> parameters() override {
    return {{"drag_factor", &drag_factor, "1", 0, 10, Basis::assumed, "Multiplies both drags."}};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const double mu = fluid.dynamic_viscosity, per_speed = fluid.density * particles.diameter / mu;
    const double factor = drag_factor * mu * 2 * particles.rag.radius;
    const VectorArray u = fluid.velocity, v = particles.velocity;
    const VectorSum force = forces.force;
    double* slope = forces.slope;
    const LatticeDirections lattice(particles);
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const cylinder::Drag drag =
          cylinder::drag<cylinder::Along::cable>(u[p] - v[p], direction(lattice.along(p)), per_speed, factor, {0, 0});
      force.x[p] += drag.force.x, force.y[p] += drag.force.y, force.z[p] += drag.force.z;
      slope[p] += drag.slope;
    }
  }
  std::vector<ReferenceCase> reference_cases() const override { return cylinder::measured_across(); }
};
[[maybe_unused]] const bool registered = fluid_forces().add<CylinderSegments>();

}  // namespace
}  // namespace snag
