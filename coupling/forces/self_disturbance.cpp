// The water that a kernel averages holds what the particle itself does to it; its drag wants the water without, along the nearest wall (t)
// and across it (n):
//
//   u - v -> (1 + theta (1/(1 - c) - 1)) (u - v),   c = K (psi A/delta + psi_s e)/(6 pi^(3/2) mu)
//   psi = (1 + 0.566 Re_delta)/(1 + 1.228 Re_delta + 0.426 Re_delta^2),   Re_delta = rho W delta/mu
//   A_t = 1 - (0.6541 - 0.1092 s + 0.0143 s^2 + 0.0187 s^3)/(1 - 0.0601 s + 0.0639 s^2 + 0.0034 s^3 + 0.01875 s^4),   s = h/delta
//   A_n = 1 - (0.9445 - 0.0884 s + 0.0498 s^2 + 0.0253 s^3)/(1 - 0.0497 s + 0.0851 s^2 + 0.0176 s^3 + 0.01271 s^4),   h: distance of the
//   wall
//
// c w is what the drag F = K w, spread by a Gaussian of width delta, leaves in the average by the same Gaussian in water that goes past the
// particle. W is half-way between the slips with and without the disturbance: with either alone a sphere at Re 1 falls 0.7 % too slowly or
// 1.0 % too fast. psi is the steady Oseen solution without walls (to 0.03 %). A is the share that is left
// at a plane wall without slip in creeping flow, of the kernel that the wall cuts and whose weights coupling/kernel.hpp balances (to 0.2
// %). So the whole answer of the water to the particle is taken off, with what the wall does to it: the force `wall` gives the drag at a
// wall, nothing counts twice. K = |F|/|w| of the sub-step before holds whatever law and factors of drag there are. delta^2 = (kernel
// width/q)^2 + (0.25 cell size)^2: the answer of a single cell to its own force; q: how much of itself the kernel holds against a
// Gaussian, 1 (coupling/kernel_shape.hpp). e: what points of a kernel that lie apart
// add, each smeared over s = 0.25 cell size; psi_s = psi(rho W s/mu). For particles apart from each
// other, in water that has had the time delta^2/nu; c counts as at most 0.8; a particle beyond its wall counts as at the wall. In a
// prescribed flow and one-way there is nothing to correct. Source: Stokes and Oseen flow by Fourier transform, images of Blake (1971),
// Proc. Camb. Phil. Soc. 70, 303-310; in the manner of Balachandar, Liu and Lakhote (2019), J. Comput. Phys. 376, 160-185, and Evrard,
// Denner and van Wachem (2020), Int. J. Multiphase Flow 132, 103535.
#include <algorithm>
#include <numbers>

#include "coupling/fluid_force.hpp"
#include "coupling/vector_math.hpp"

namespace snag {
namespace {

constexpr double most_disturbance = 0.8;  // c

/// 1/(1 - c).
inline double growth_of(double c) { return 1 / (1 - std::min(c, most_disturbance)); }
/// psi(Re_delta).
inline double oseen(double re) { return (1 + 0.565925 * re) / (1 + re * (1.227564 + 0.425794 * re)); }
/// A_t(s) and A_n(s).
inline double share_along(double s) {
  return 1 - (0.654108 + s * (-0.109166 + s * (0.014291 + 0.0186973 * s))) /
                 (1 + s * (-0.060116 + s * (0.063857 + s * (0.003443 + 0.0187535 * s))));
}
inline double share_across(double s) {
  return 1 - (0.944451 + s * (-0.088431 + s * (0.049842 + 0.0253396 * s))) /
                 (1 + s * (-0.049672 + s * (0.085127 + s * (0.017609 + 0.0127079 * s))));
}

struct SelfDisturbance final : FluidForce {
  static constexpr const char* name = "self_disturbance";
  double strength = 1;

  ForceDescription description() const override {
    return {.name = name,
            .equation = "u - v -> (1 + theta (1/(1 - c) - 1)) (u - v), c = K (psi A/delta + psi_s e)/(6 pi^(3/2) mu)",
            .source = "steady Oseen flow about a Gaussian force, images at a wall; Balachandar, Liu and Lakhote (2019)",
            .valid_for = "two-way coupled particles that are several kernel widths apart, with the force wall at walls",
            .samples = {.wall = true, .disturbance = true, .point_disturbance = true},
            .needs_drag = true,
            .role = Role::fluid,
            .prior = Prior{.key = "coupling.self_disturbance.strength",
                           .meaning = "share of the particle's own disturbance that is taken off",
                           .mean = 1,
                           .sd = 0.5,
                           .minimum = 0,
                           .maximum = 2,
                           .acts_on_water = true}};
  }
  std::vector<Parameter> parameters() override {
    return {{"strength", &strength, "1", 0, 2, Basis::literature, "Strength theta of the correction; 1 by theory, 0: no correction."}};
  }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (strength == 0) return;
    const double rho = fluid.density, mu = fluid.dynamic_viscosity, theta = strength;
    const double stokes = 1 / (6 * std::pow(std::numbers::pi, 1.5) * mu);
    const VectorArray u = fluid.velocity, v = particles.velocity, normal = fluid.wall_normal;
    const VectorSum seen = forces.fluid_velocity;
    const double *width = fluid.disturbance_width, *distance = fluid.wall_distance, *points = fluid.point_disturbance,
                 *point_width = fluid.point_width, *drag = particles.last_drag;
    double* growth = forces.slip_growth;
#pragma omp simd
    for (int p = particles.begin; p < particles.end; ++p) {
      const Vec3 sampled = u[p] - v[p], n = normal[p];
      const double delta = width[p], s = std::max(distance[p], 0.0) / delta, across = dot(sampled, n);
      const double c = drag[p] * stokes / delta, near = drag[p] * stokes * points[p], across_share = share_across(s),
                   along_share = share_along(s);
      const double slip_n = across * across, slip_t = std::max(norm_squared(sampled) - slip_n, 0.0);
      double g_t = 1, g_n = 1;  // undisturbed over sampled slip, by repeated insertion
      for (int i = 0; i < 3; ++i) {
        const double half_way = 0.5 * std::sqrt((1 + g_t) * (1 + g_t) * slip_t + (1 + g_n) * (1 + g_n) * slip_n);
        const double psi = oseen(rho * half_way * delta / mu), at_points = near * oseen(rho * half_way * point_width[p] / mu);
        g_t = growth_of(psi * c * along_share + at_points), g_n = growth_of(psi * c * across_share + at_points);
      }
      const double more_t = theta * (g_t - 1), more_n = theta * (g_n - 1);
      const Vec3 more = more_t * sampled + (more_n - more_t) * across * n;
      seen.x[p] += more.x, seen.y[p] += more.y, seen.z[p] += more.z;
      growth[p] *= 1 + std::max(more_t, more_n);
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    auto wide = stokes_limit();
    wide.what = "kernel ten thousand times the sphere: nothing to correct";
    wide.state.disturbance_width = 1e4 * wide.state.diameter;
    auto narrow = stokes_limit();
    narrow.what = "kernel as wide as the sphere, creeping flow";
    narrow.source = "Gaussian Stokeslet averaged by the same Gaussian: F/(6 pi^(3/2) mu delta)";
    narrow.state.disturbance_width = narrow.state.diameter;
    narrow.force = 1 / (1 - 0.5 / std::sqrt(std::numbers::pi)) * narrow.force, narrow.tolerance = 1e-3;
    auto along = narrow, across = narrow;
    along.source = across.source = "point force and its image at a plane wall, Blake (1971): 9/16 and 9/8 of d/(2 h) of Stokes' velocity";
    const double far = 20, share = 0.5 / std::sqrt(std::numbers::pi);  // h/delta
    along.what = "20 widths from a wall, along it", across.what = "20 widths from a wall, across it";
    along.state.wall_distance = across.state.wall_distance = far * narrow.state.diameter;
    along.state.wall_normal = {0, 1, 0}, across.state.wall_normal = {1, 0, 0};
    along.force = (1 - share) / (1 - share + 9.0 / 32 / far) * narrow.force;
    across.force = (1 - share) / (1 - share + 9.0 / 16 / far) * narrow.force;
    return {wide, narrow, along, across};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<SelfDisturbance>();

}  // namespace
}  // namespace snag
