// Drag of a fibre along and across its axis, in place of a share theta of the drag of its particles:
//
//   F = (1 - theta) F_drag + theta mu l (f_n w_n + f_t w_t)
//   t: unit vector along the fibre from the bonded neighbours,   w_t = (w.t) t,   w_n = w - w_t,   l = 2 r_p
//
//   f_n = max(any length, creeping)                              (coupling/cylinder_drag.hpp), p = L/d of the whole fibre, at least 2
//   form "cable"    f_t = max(cable, creeping)
//   form "swept"    f_t = max(swept layer, creeping)
//
// In creeping flow the drag along a slender fibre is half of that across it: a fibre that falls at an angle drifts, by 19.5 degrees at most
// (sin = 1/3). At large Re the drag across follows the velocity across alone. Each particle has the mean drag of the fibre: that its ends
// have more is not felt, nor are neighbouring fibres and walls. Particles that have neighbours in no or in two directions (spheres, cloth)
// keep the drag that they have; of a fibre that tore, the parts still count with its whole length.
// Source: Taylor (1952), Proc. R. Soc. A 214, 158-183; Batchelor (1970), J. Fluid Mech. 44, 419-440; laws: coupling/cylinder_drag.hpp.
#include "coupling/cylinder_drag.hpp"
#include "coupling/lattice_directions.hpp"

namespace snag {
namespace {

struct FibreDrag final : FluidForce {
  static constexpr const char* name = "fibre_drag";
  double share = 1;
  using Form = cylinder::Along;
  Choice<Form> form{Form::cable, {"cable", "swept"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = (1 - theta) F_drag + theta mu l (f_n w_n + f_t w_t)",
            .source = "Taylor (1952); Batchelor (1970); Casarella and Choo (1971); Tirado, Lopez Martinez and Garcia de la Torre (1984)",
            .valid_for = "fibres of at least twice their diameter, Re < 1e5",
            .role = Role::drag_replacement,
            .prior = Prior{.key = "coupling.fibre_drag.share",
                           .meaning = "share of the drag that differs along and across the fibre",
                           .mean = 0.8,
                           .sd = 0.4,
                           .minimum = 0,
                           .maximum = 1,
                           .is_share = true,
                           .needs = {Need::fibre}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"share", &share, "1", 0, 1, Basis::assumed, "Weight theta of the fibre law; 0: drag of the particles, 1: drag of the fibre."},
            setting("form", &form,
                    "Drag along the fibre beyond creeping flow. cable: measured on towed cables; swept: laminar layer that the flow across "
                    "keeps thin.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (share == 0) return;
    if (form == Form::cable)
      add<Form::cable>(fluid, particles, forces);
    else
      add<Form::swept>(fluid, particles, forces);
  }

 private:
  template <Form law>
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const {
    const double mu = fluid.dynamic_viscosity, per_speed = fluid.density * particles.diameter / mu, l = 2 * particles.rag.radius;
    const cylinder::Creeping slow = cylinder::creeping(static_cast<double>(particles.rag.n_particles) * l / particles.diameter);
    const double mu_l = mu * l, theta = share;
    const VectorArray u = fluid.velocity, v = particles.velocity;
    const VectorSum force = forces.force;
    double* slope = forces.slope;
    const LatticeDirections lattice(particles);
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 row = lattice.along(p), column = lattice.across(p);
      const double has_row = norm_squared(row) > 0 ? 1 : 0, has_column = norm_squared(column) > 0 ? 1 : 0;
      const cylinder::Drag drag = cylinder::drag<law>(u[p] - v[p], direction(row + column), per_speed, mu_l, slow);
      const double here = has_row + has_column == 1 ? theta : 0, rest = 1 - here;
      force.x[p] = rest * force.x[p] + here * drag.force.x;
      force.y[p] = rest * force.y[p] + here * drag.force.y;
      force.z[p] = rest * force.z[p] + here * drag.force.z;
      slope[p] = rest * slope[p] + here * drag.slope;
    }
  }

 public:
  std::vector<ReferenceCase> reference_cases() const override { return cylinder::measured_across(); }
};
[[maybe_unused]] const bool registered = fluid_forces().add<FibreDrag>();

}  // namespace
}  // namespace snag
