#pragma once
// Velocity and acceleration of a wall that turns:   u = omega x (x - x_0),   a = domega/dt x (x - x_0) + omega x u
// Nothing passes through it: the flux is the volume that the mesh face sweeps, whatever the rounding of the wall into flat faces.
#include "solver/boundaries/boundary.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

/// Motion of a body that turns about a point.
struct Turning {
  Vec3 origin;  // m
  Vec3 speed;   // omega, rad/s
  Vec3 change;  // domega/dt, rad/s2

  /// At the end of a step, from omega there and at its begin; at flow.time itself as steady.
  static Turning over_step(const Flow& flow, double time, const Vec3& origin, const Vec3& speed, const Vec3& speed_before) {
    return {origin, speed, time > flow.time ? (speed - speed_before) / (time - flow.time) : Vec3{}};
  }
  Vec3 velocity(const Vec3& x) const { return cross(speed, x - origin); }
  Vec3 acceleration(const Vec3& x) const { return cross(change, x - origin) + cross(speed, velocity(x)); }
};

/// Key of the roughness of a wall.
inline Parameter roughness_parameter(double* height) {
  return {"roughness_height",
          height,
          "m",
          0,
          infinity,
          Basis::assumed,
          "Equivalent sand roughness of the wall, for wall functions; cast iron has some 0.25 mm (Moody 1944). 0: smooth."};
}

/// Values of the boundary face f of a wall that turns, and slides along itself with `slide`, m/s.
inline void set_turning_wall(const Turning& turning, const Vec3& slide, const Flow& flow, int f, BoundaryValues& values) {
  const int b = f - flow.mesh.n_interior;
  values.velocity[b] = slide + turning.velocity(flow.mesh.face_centre[f]);
  values.flux[b] = flow.mesh_flux[f];
  values.acceleration[b] = turning.acceleration(flow.mesh.face_centre[f]);
  values.spin[b] = turning.speed;
}

/// Values of all faces of a wall at a time: those of cells of the turning zone turn with it, unless the wall is `stationary`.
inline void set_wall_of_zone(bool stationary, const Flow& flow, const Patch& patch, double time, BoundaryValues& values) {
  const RotatingZone* zone = stationary ? nullptr : flow.rotating_zone;
  const Turning still,
      turning = zone ? Turning::over_step(flow, time, zone->origin(), zone->rotation_speed(time), zone->rotation_speed(flow.time)) : still;
  for (int f = patch.first; f < patch.end(); ++f) {
    const bool turns = zone && flow.mesh.cell_zone[flow.mesh.owner[f]] == zone->zone();
    set_turning_wall(turns ? turning : still, {}, flow, f, values);
  }
}

}  // namespace snag
