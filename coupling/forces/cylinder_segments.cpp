// Drag of a fibre, segment by segment: a cylinder of diameter d and length l = 2 r_p about the direction t of the row at the particle,
//
//   normal:      F = 1/2 mu l (C_n Re_n) w_n,    w_n = w - (w.t) t,   Re_n = rho |w_n| d/mu
//   tangential:  F = pi mu l (0.55 Re^(1/2) + 0.084 Re^(2/3)) w_t,    Re = rho |w| d/mu, so that axial flow drags, too
//   C_n = 8 pi/(Re_n s) (1 - 0.87 s^-2), s = ln(8/Re_n) - 0.0772     Re_n < 1
//         1.45 + 8.55 Re_n^-0.9                                      1 <= Re_n < 30
//         1.1 + 4 Re_n^-0.5                                          Re_n >= 30
//
// A particle without neighbours in its row counts as a cylinder across the flow. Ends and neighbouring fibres are not felt.
// Source: Casarella and Choo (1971), J. Hydronaut. 5, 3-10 (there with Re_n in both directions).
#include <algorithm>
#include <numbers>

#include "coupling/lattice_directions.hpp"
#include "coupling/vector_math.hpp"

namespace snag {
namespace {

/// C_n Re_n.
inline double normal_drag(double Re) {
  const double creeping_Re = std::clamp(Re, 1e-9, 1.0), s = log(8 / creeping_Re) - 0.077215665;
  const double creeping = 8 * std::numbers::pi / s * (1 - 0.87 / (s * s));
  const double large_Re = std::max(Re, 1.0);
  const double moderate = 1.45 * large_Re + 8.55 * pow(large_Re, 0.1), fast = 1.1 * large_Re + 4 * std::sqrt(large_Re);
  return Re < 1 ? creeping : Re < 30 ? moderate : fast;
}

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
      const Vec3 t = direction(lattice.along(p)), w = u[p] - v[p], w_t = dot(w, t) * t, w_n = w - w_t;
      const double Re = per_speed * std::sqrt(norm_squared(w)), Re_n = per_speed * std::sqrt(norm_squared(w_n));
      const double K_n = factor * 0.5 * normal_drag(Re_n);
      const double K_t = factor * std::numbers::pi * (0.55 * std::sqrt(Re) + 0.084 * pow(Re, 2.0 / 3));
      force.x[p] += K_n * w_n.x + K_t * w_t.x, force.y[p] += K_n * w_n.y + K_t * w_t.y, force.z[p] += K_n * w_n.z + K_t * w_t.z;
      slope[p] += std::max(K_n, K_t);
    }
  }
  std::vector<ReferenceCase> reference_cases() const override {
    std::vector<ReferenceCase> cases;
    for (const auto& [Re, C_d, tolerance] : {std::array{100.0, 1.45, 0.08}, std::array{1e4, 1.1, 0.08}, std::array{10.0, 2.8, 0.1}}) {
      auto across = drag_at(Re, 0, tolerance, "Wieselsberger (1921), as given by Tritton (1959): circular cylinder across the flow");
      across.state.next_in_row = {0, 0, across.state.diameter};
      const double speed = norm(across.state.velocity), d = across.state.diameter;
      across.force = {0.5 * across.state.fluid_density * C_d * d * d * speed * speed, 0, 0};
      cases.push_back(across);
    }
    return cases;
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<CylinderSegments>();

}  // namespace
}  // namespace snag
