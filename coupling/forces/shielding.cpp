// Shelter by neighbours in the cloth:   F = (1 - theta s) F_drag
//
//   form "bonded"   s: whole bonds of the particle over 4, whatever the direction of the flow
//   form "wake"     s: largest cosine, squared, between the slip and a bond that comes from upstream: a neighbour ahead takes the flow
//   form "mutual"   s: the same of a bond from either side
//
// In creeping flow two spheres in a row have the same drag, at large Re the one behind has less. Flows in between lie between the forms
// "mutual" and "wake".
// Source: drag in rows and arrays is below that of a single body by up to three quarters: Hoerner (1965), chapter 8; Zukauskas (1972);
// two spheres in creeping flow: Stimson and Jeffery (1926). The form of s is a model.
#include <algorithm>

#include "coupling/lattice_directions.hpp"

namespace snag {
namespace {

struct Shielding final : FluidForce {
  static constexpr const char* name = "shielding";
  double shelter = 0.5;
  enum class Form { bonded, wake, mutual };
  Choice<Form> form{Form::bonded, {"bonded", "wake", "mutual"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = (1 - theta s) F_drag",
            .source = "Hoerner (1965), chapter 8; form assumed",
            .valid_for = "particles of a cloth or fibre under the drag of single spheres",
            .role = Role::drag_modifier,
            .prior = Prior{.key = "coupling.shielding.shelter",
                           .meaning = "share of drag lost in full shelter",
                           .mean = 0.5,
                           .sd = 0.25,
                           .minimum = 0,
                           .maximum = 0.95,
                           .needs = {Need::bonds}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"shelter", &shelter, "1", 0, 1, Basis::assumed, "theta: fraction of the drag that a fully sheltered particle loses."},
            setting("form", &form,
                    "bonded: by the number of neighbours; wake: by a neighbour upstream; mutual: by a neighbour upstream or downstream.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    const bool bonded = form == Form::bonded;
    const double least_cosine = form == Form::wake ? 0 : -1;
    const double theta = shelter;
    const VectorArray u = fluid.velocity, v = particles.velocity, x = particles.position;
    const double *along = particles.tile.bond_x.data(), *across = particles.tile.bond_y.data();
    const int stride = particles.tile.stride;
    const VectorSum force = forces.force;
    double* slope = forces.slope;
    const LatticeDirections lattice(particles);
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 w = direction(u[p] - v[p]);
      const auto from = [&](double bond, int neighbour) {
        const double c = std::max(dot(direction(x[p] - x[neighbour]), w), least_cosine);
        return bond * c * c;
      };
      const double row = std::max(from(along[p - 1], p - 1), from(along[p], p + 1));
      const double column = std::max(from(across[p - stride], p - stride), from(across[p], p + stride));
      const double s = bonded ? 0.25 * lattice.count(p) : std::max(row, column), f = 1 - theta * s;
      force.x[p] *= f, force.y[p] *= f, force.z[p] *= f;
      slope[p] *= f;
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    auto alone = stokes_limit();
    alone.what = "a sphere alone has no shelter";
    return {alone};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Shielding>();

}  // namespace
}  // namespace snag
