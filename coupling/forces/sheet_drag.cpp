// Resistance of a sheet by its local tangent plane, in place of a share theta of the drag of its particles:
//
//   F = (1 - theta) F_drag + theta (1/2 rho C_n A |w_n| w_n + rho C_t A |w_t| w_t),   A = (2 r_p)^2: the cloth that a particle stands for
//   n: unit normal of the cloth from the bonded neighbours along and across the rows,   w_n = (w.n) n,   w_t = w - w_n
//
//   form "quadratic"   C_n, C_t as given: bluff plate, rough surface on both sides
//   form "viscous"     C_n + 20.4/Re, C_t + 1.328/Re^(1/2), Re = rho |w| 2 r_p/mu: plates in creeping flow; laminar layers on both sides,
//                      mean over a plate of the length 2 r_p, as if they began anew at each particle
//
// One-way C_n is the drag coefficient of a plate across the stream, 1.17. In a two-way coupling the velocity at the sheet is the resolved
// one, and C_n is the loss coefficient K of the cloth: the pressure drop across it over 1/2 rho |w_n| w_n. A free-stream coefficient there
// would count the blockage of the sheet twice. No measured K of a soaked wipe is known: 2 is an assumption. Above 4 the kernel's width
// makes a plate larger than it is, and its resistance too high. Particles that have not neighbours in both directions (fibres, spheres)
// keep the drag that they have.
// Source: resistance of screens, Taylor and Batchelor (1949), Q. J. Mech. Appl. Math. 2, 1-29; plate across the flow C_n = 1.17, Hoerner
// (1965), chapter 3; disc in creeping flow, Lamb (1932), section 339; laminar layer, Blasius (1908).
#include <algorithm>

#include "coupling/lattice_directions.hpp"

namespace snag {
namespace {

struct SheetDrag final : FluidForce {
  static constexpr const char* name = "sheet_drag";
  static constexpr double of_plate = 1.17, of_cloth = 2;  // C_n one-way and two-way
  double share = 1, tangential_coefficient = 0.02, chosen_coefficient = of_plate;
  std::optional<double> normal_coefficient;
  std::string form = "quadratic";

  Card card() const override {
    return {.name = name,
            .equation = "F = (1 - theta) F_drag + theta (1/2 rho C_n A |w_n| w_n + rho C_t A |w_t| w_t)",
            .source = "Taylor and Batchelor (1949); Hoerner (1965)",
            .valid_for = "sheets resolved by particles",
            .role = Role::drag_replacement,
            .prior = Prior{.key = "coupling.sheet_drag.share",
                           .meaning = "share of the drag that follows the plane of the sheet",
                           .mean = 0.8,
                           .sd = 0.4,
                           .minimum = 0,
                           .maximum = 1,
                           .needs = {Need::sheet}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"share", &share, "1", 0, 1, Basis::assumed, "Weight theta of the sheet law; 0: drag of the particles, 1: drag of the sheet."},
            {"normal_coefficient", &normal_coefficient, "1", 0, 1e6, Basis::literature,
             "C_n: one-way the drag coefficient of a plate normal to the flow, by default 1.17; two-way the loss coefficient of the cloth, "
             "by default 2."},
            {"tangential_coefficient", &tangential_coefficient, "1", 0, 10, Basis::assumed, "C_t: friction coefficient of one side."},
            setting("form", &form, "quadratic: constant coefficients; viscous: with the terms of slow flow.", {"quadratic", "viscous"})};
  }
  void set_coupling(bool two_way) override { chosen_coefficient = two_way ? of_cloth : of_plate; }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (share == 0) return;
    const double rho = fluid.density, side = 2 * particles.rag.radius, area = side * side,
                 C_n = normal_coefficient.value_or(chosen_coefficient), C_t = tangential_coefficient, theta = share,
                 viscous = form == "viscous" ? 1 : 0;
    const double per_speed = rho * side / fluid.dynamic_viscosity;
    const VectorArray u = fluid.velocity, v = particles.velocity;
    const VectorSum force = forces.force;
    double* slope = forces.slope;
    const LatticeDirections lattice(particles);
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 n = direction(cross(lattice.along(p), lattice.across(p)));
      const Vec3 w = u[p] - v[p], w_n = dot(w, n) * n, w_t = w - w_n;
      const double speed = std::sqrt(norm_squared(w)), speed_n = std::sqrt(norm_squared(w_n)), speed_t = std::sqrt(norm_squared(w_t));
      // C |w| with C = c/Re is c mu/(rho d), and with c/Re^(1/2) it is c |w|^(1/2) (mu/(rho d))^(1/2): finite at rest.
      const double K_n = 0.5 * rho * area * (C_n * speed_n + viscous * 20.4 / per_speed);
      const double K_t = rho * area * (C_t * speed_t + viscous * 1.328 * std::sqrt(speed / per_speed));
      const double b = norm_squared(n) > 0.5 ? theta : 0, rest = 1 - b;
      force.x[p] = rest * force.x[p] + b * (K_n * w_n.x + K_t * w_t.x);
      force.y[p] = rest * force.y[p] + b * (K_n * w_n.y + K_t * w_t.y);
      force.z[p] = rest * force.z[p] + b * (K_n * w_n.z + K_t * w_t.z);
      slope[p] = rest * slope[p] + b * std::max(K_n, K_t);
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    auto broadside = drag_at(1e4, 0, 1e-12, "Hoerner (1965), chapter 3: plate across the flow, C_d = 1.17");
    const double d = broadside.state.diameter, speed = norm(broadside.state.velocity);
    broadside.state.next_in_row = {0, d, 0}, broadside.state.next_row = {0, 0, d};
    broadside.force = {0.5 * broadside.state.fluid_density * 1.17 * d * d * speed * speed, 0, 0};
    return {broadside};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<SheetDrag>();

}  // namespace
}  // namespace snag
