#pragma once
// Changes of whatever drag is active: F -> f F, K -> f K, with a factor f of each particle.
#include <cmath>

#include "coupling/fluid_force.hpp"
#include "coupling/vector_math.hpp"

namespace snag {

/// `factor(p, Re, speed)` multiplies force and slope of particle p; Re = rho |w| d/mu, speed |w| in m/s, w = u - v. Plain numbers: a struct
/// of them would not vectorise.
template <class Factor>
void multiply_drag(const FluidSamples& fluid, const Particles& particles, const Forces& forces, const Factor& factor) {
  const double per_speed = fluid.density * particles.diameter / fluid.dynamic_viscosity;
  const VectorArray u = fluid.velocity, v = particles.velocity;
  const VectorSum force = forces.force;
  double* slope = forces.slope;
#pragma omp simd
  for (int p = particles.begin; p < particles.end; ++p) {
    const double wx = u.x[p] - v.x[p], wy = u.y[p] - v.y[p], wz = u.z[p] - v.z[p];
    const double speed = std::sqrt(wx * wx + wy * wy + wz * wz);
    const double f = factor(p, per_speed * speed, speed);
    force.x[p] *= f, force.y[p] *= f, force.z[p] *= f;
    slope[p] *= f;
  }
}

}  // namespace snag
