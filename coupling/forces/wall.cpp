// Drag near a wall: the part of the slip towards the wall and the part along it meet more resistance,
//
//   F -> lambda_n F_n + lambda_t F_t,   lambda -> 1 + theta (lambda - 1),   s = a/h,  a: radius, h: distance of the centre, gap h - a
//
//   form "leading"
//     lambda_n = 1/(1 - 9/8 s)
//     lambda_t = 1/(1 - 9/16 s)
//
//   form "series"
//     lambda_n = (6 g^2 + 9 g + 2)/(6 g^2 + 2 g),  g = h/a - 1                  Brenner's series to 0.6 %
//     lambda_t = 1/(1 - 9/16 s + 1/8 s^3 - 45/256 s^4 - 1/16 s^5)               to 1 % for h > 1.5 a
//
// The gap counts as at least `least_gap` radii (roughness); "leading" has its pole at h = 9/8 a and takes h of at least 1.25 a. One wall,
// the nearest; shear along the wall and lift by it are left out. Beyond 10 diameters from a wall of triangles nothing is added.
// Source: Brenner (1961), Chem. Eng. Sci. 16, 242-251, with the fit of Bevan and Prieve (2000), J. Chem. Phys. 113, 1228-1236; Faxen
// (1923), Ark. Mat. Astron. Fys. 17, 27; Lorentz (1907): leading order; Happel and Brenner (1983), section 7-4.
#include <algorithm>

#include "coupling/fluid_force.hpp"

namespace snag {
namespace {

struct Wall final : FluidForce {
  static constexpr const char* name = "wall";
  double strength = 1, least_gap = 0.01;
  enum class Form { series, leading };
  Choice<Form> form{Form::series, {"series", "leading"}};

  ForceDescription description() const override {
    return {.name = name,
            .equation = "F -> (1 + theta (lambda_n - 1)) F_n + (1 + theta (lambda_t - 1)) F_t",
            .source = "Brenner (1961), Faxen (1923), Lorentz (1907)",
            .valid_for =
                "spheres near one plane wall, Re < 1; two-way beside self_disturbance, which takes off what the resolved wall does (alone "
                "it counts a part of that twice)",
            .samples = {.wall = true},
            .role = Role::drag_modifier,
            .prior = Prior{.key = "coupling.wall.strength",
                           .meaning = "share of the theoretical increase of drag by the wall",
                           .mean = 1,
                           .sd = 0.5,
                           .minimum = 0,
                           .maximum = 5,
                           .needs = {Need::wall}}};
  }
  std::vector<Parameter> parameters() override {
    return {{"strength", &strength, "1", 0, 10, Basis::literature, "Strength theta of the wall correction; 1 by theory."},
            {"least_gap", &least_gap, "1", 1e-6, 1, Basis::assumed, "Least gap over radius: roughness keeps lubrication finite."},
            setting("form", &form, "leading: first order in a/h; series: to contact.")};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (strength == 0) return;
    const bool series = form == Form::series;
    const double a = 0.5 * particles.diameter, theta = strength, least = series ? 1 + least_gap : 1.25;
    const double* distance = fluid.wall_distance;
    const VectorArray normal = fluid.wall_normal;
    const VectorSum force = forces.force;
    double* slope = forces.slope;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const double x = std::max(distance[p] / a, least), s = 1 / x, g = x - 1;
      const double first_n = 1 / (1 - 9.0 / 8 * s), first_t = 1 / (1 - 9.0 / 16 * s);
      const double full_n = (2 * s * s + g * s * (9 * s + 6 * g * s)) / (g * s * (2 * s + 6 * g * s));
      const double full_t = 1 / (1 + s * (-9.0 / 16 + s * s * (1.0 / 8 + s * (-45.0 / 256 - s / 16))));
      const double f_n = 1 + theta * ((series ? full_n : first_n) - 1), f_t = 1 + theta * ((series ? full_t : first_t) - 1);
      const Vec3 n = normal[p], F{force.x[p], force.y[p], force.z[p]};
      const Vec3 changed = f_t * F + (f_n - f_t) * dot(F, n) * n;
      force.x[p] = changed.x, force.y[p] = changed.y, force.z[p] = changed.z;
      slope[p] *= std::max(f_n, f_t);
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    std::vector<ReferenceCase> cases;
    const auto at = [&](double h_over_a, double factor, const Vec3& n, double tolerance, const char* source) {
      auto reference = stokes_limit();
      reference.what = "h/a = " + std::to_string(h_over_a) + (n.x != 0 ? ", towards the wall" : ", along the wall");
      reference.source = source;
      reference.state.wall_distance = 0.5 * h_over_a * reference.state.diameter, reference.state.wall_normal = n;
      reference.force = factor * reference.force, reference.tolerance = tolerance;
      cases.push_back(reference);
    };
    const char* normal = "Brenner (1961), Table 1";
    at(10.0677, 1.1252, {1, 0, 0}, 0.007, normal), at(3.7622, 1.4129, {1, 0, 0}, 0.007, normal);
    at(1.5431, 3.0361, {1, 0, 0}, 0.007, normal), at(1.1276, 9.2518, {1, 0, 0}, 0.007, normal);
    const char* along = "Goldman, Cox and Brenner (1967), Table 2, exact";
    at(10.0677, 1.0587, {0, 1, 0}, 0.002, along), at(3.7622, 1.1738, {0, 1, 0}, 0.002, along), at(2.3524, 1.3079, {0, 1, 0}, 0.002, along);
    at(1.5431, 1.5675, {0, 1, 0}, 0.012, along);
    return cases;
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<Wall>();

}  // namespace
}  // namespace snag
