#pragma once
// Drag laws of a sphere share one form:
//
//   F = 1/2 rho C_d(Re) A |w| w,   A = pi d^2/4,   w = u - v,   Re = rho |w| d / mu
//     = K w,   K = pi/8 mu d (C_d Re),
//
// written with C_d Re = 24 f(Re), finite at rest, so that no law divides 0/0. K is also the slope for the implicit step (secant).
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

#include "coupling/fluid_force.hpp"
#include "coupling/vector_math.hpp"

namespace snag {

/// A drag law with its factor.
struct SphereDrag : FluidForce {
  double drag_factor = 1;
  std::vector<Parameter> parameters() override {
    return {{"drag_factor", &drag_factor, "1", 0, 10, Basis::assumed, "Multiplies C_d; a particle of a rag is not an isolated sphere."}};
  }
};

/// A drag law of particles of any shape, by their sphericity too.
struct ShapeDrag : SphereDrag {
  double sphericity = 1;
  std::vector<Parameter> parameters() override {
    auto records = SphereDrag::parameters();
    records.push_back({"sphericity", &sphericity, "1", 0.05, 1, Basis::assumed,
                       "phi: surface of the sphere of the same volume over the surface of the particle."});
    return records;
  }
};

/// `drag_times_Re(Re)` or, where it depends on more of the particle p than that, `drag_times_Re(Re, p)` is C_d Re.
template <class Law>
void add_sphere_drag(const FluidSamples& fluid, const Particles& particles, const Forces& forces, const Law& drag_times_Re) {
  const double rho = fluid.density, mu = fluid.dynamic_viscosity, d = particles.diameter;
  const double K_factor = std::numbers::pi / 8 * mu * d;
  // Local copies of the pointers, component by component: through the structs they would be read again for every particle, and nothing
  // would vectorise.
  const VectorArray u = fluid.velocity, v = particles.velocity;
  const VectorSum force = forces.force;
  double* slope = forces.slope;
#pragma omp simd
  for (int p = particles.begin; p < particles.end; ++p) {
    const double wx = u.x[p] - v.x[p], wy = u.y[p] - v.y[p], wz = u.z[p] - v.z[p];
    const double Re = rho * std::sqrt(wx * wx + wy * wy + wz * wz) * d / mu;
    const double K = K_factor * [&] {
      if constexpr (std::is_invocable_v<Law, double, int>)
        return drag_times_Re(Re, p);
      else
        return drag_times_Re(Re);
    }();
    force.x[p] += K * wx, force.y[p] += K * wy, force.z[p] += K * wz;
    slope[p] += K;
  }
}

}  // namespace snag
