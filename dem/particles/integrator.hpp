#pragma once
// Motion of free spheres:  m dv/dt = F + m g,   i dw/dt = T,   dx/dt = v,   dq/dt = 1/2 (0, w) q      (m, i: mass and moment of inertia)
//
// Drift-kick-drift: half a step of motion, forces there, the whole kick, half a step of motion. This is leapfrog: the same orbits as
// kick-drift-kick, symplectic, second order (dashpots, drag and friction see the velocity half a step late: first order in c dt/m, which
// the step limit keeps small). It is preferred because each force is evaluated once and applied whole within the step: an impulse summed by
// the coupling is what the particles received, to round-off, and nothing of the forces has to be kept for a restart or another rank.
//
// Rotation by the exponential map, q <- exp(dt w/2) q: exact for a constant w.
#include <algorithm>
#include <limits>

#include "base/vec3.hpp"
#include "dem/particles/tile.hpp"

namespace snag {

/// Move the particles of a tile for `dt`, s, with their velocities. Ring and absent particles are of no matter.
void drift(Tile& tile, double dt);

struct Inertia {
  double mass = 1;    // kg
  double moment = 1;  // kg m2
  Vec3 gravity;       // m/s2
};
/// Smallest and largest of a vector over particles; lower > upper if there is none.
struct Box {
  Vec3 lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity};
  bool empty() const { return !(lower.x <= upper.x); }
  void include(const Box& other) {
    for (int c = 0; c < 3; ++c) lower[c] = std::min(lower[c], other.lower[c]), upper[c] = std::max(upper[c], other.upper[c]);
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

/// Change velocities by the forces fx .. tz and gravity over `dt`, then drift for `dt_drift`. Particles that are not free keep their
/// velocity, and their rotation unless they are pinned. Returns bounds of the velocities with which they drift, m/s.
Box kick_and_drift(Tile& tile, const Inertia& inertia, double dt, double dt_drift);

/// Of the positions in row j of a tile, m.
Box bounding_box(const Tile& tile, int j);

}  // namespace snag
