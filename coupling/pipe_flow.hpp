#pragma once
// What the water of a pipe may do beyond the flow of the case: modes that are added to it. With U its mean speed along the pipe, R the
// radius of the pipe, t the direction of its axis, o the place from the axis, r = |o|, and b = t x c, c towards the inside of the bend:
//
//   swirl          s U t x o/(R h)                     s: speed about the axis at the wall over U; right-handed about the flow
//   profile        p U (1 - 2 r^2/R^2) t               p = 1 makes a parabola of a flat profile; the flow rate is the same
//   power law      q U ((1 + a)(1 - r/R)^(1/7) - 1)/a t, a = 11/49      q = a makes the power law of 1/7 of a flat profile, likewise
//   bend vortices  rot(psi t)/h, psi = -d g U (o.b)(1 - r^2/R^2)^2      d: speed on the axis towards the outside of the bend over U
//
//   h = 1 - (o.c)/R_b in a bend of the radius R_b, else 1;   g: 0 before the bend, grows with the angle in it, 1 behind it
//
// Each mode is free of divergence, in the bend too, and crosses no wall: swirl and vortices lie in the sections of the pipe, and h makes up
// for the sections that fan out there. At the wall the profiles slip. Swirl and profiles are exact: a solid rotation, and Poiseuille's flow
// and the power law less the flat profile; p and q are what the speed on the axis exceeds U by. The vortices have the pattern of Dean's
// pair in slow flow; at the bend's end they do not decay. The pressure of the changed flow is that of its inertia,
// grad p -> grad p - rho (Du/Dt - (Du/Dt)_0); friction is left out, which is exact for swirl.
// Source: solid rotation and Poiseuille's flow, Batchelor (1967), An Introduction to Fluid Dynamics, sections 4.2 and 4.3; power law of
// 1/7, Prandtl (1921), as in Schlichting, Boundary-Layer Theory; vortices of bends, Dean (1927), Phil. Mag. 4, 208-223; Berger, Talbot and
// Yao (1983), Annu. Rev. Fluid Mech. 15, 461-512.
#include <cmath>
#include <optional>

#include "base/parameter.hpp"
#include "base/vec3.hpp"

namespace snag {

struct Flow;

/// [pipe_flow].
struct PipeFlow {
  Vec3 point, axis{1, 0, 0};               // of the axis where the straight pipe begins, m; direction of the flow there
  double radius = 0;                       // R, m
  double bend_radius = 0, bend_angle = 0;  // R_b, m, and its angle, rad, up to `point`; 0: the pipe is straight
  Vec3 bend_inside{0, -1, 0};              // from the point to the centre of the bend
  double swirl = 0, profile = 0, profile_power_law = 0, vortices = 0;  // s, p, q, d

  Section section();
  /// Unit vectors, and only sound numbers; throws Error(usage).
  void prepare();
  bool is_there() const { return radius > 0; }
  bool has_bend() const { return bend_angle > 0; }
  /// Bound of the speed of all modes over U.
  double largest_share() const;
  bool changes_water() const { return swirl != 0 || profile != 0 || profile_power_law != 0 || vortices != 0; }
  /// Of all modes at a place; zero outside of the pipe. `speed`: U, m/s.
  Vec3 velocity(const Vec3& x, double speed) const;
  /// G_ij = du_i/dx_j, 1/s; by central differences, exact for the quadratic modes; that of the power law has no bound at the wall.
  Mat3 gradient(const Vec3& x, double speed) const;
  /// Of the pipe at a place in one of its straight parts.
  std::optional<Vec3> straight_direction(const Vec3& x) const;
  /// c at a place: towards the inside of the bend.
  Vec3 inside_at(const Vec3& x) const { return place(x).inside; }

 private:
  /// A place by the pipe.
  struct Place {
    Vec3 tangent, inside;  // t, c
    Vec3 offset;           // o, m
    double stretch = 1;    // h
    double grown = 0;      // g
    bool is_straight = true;
  };
  Place place(const Vec3& x) const;
  Vec3 modes(const Place& at, double speed) const;
};

/// Adds them to velocity, its gradient, fluxes and pressure gradient of a steady flow, whose mean speed along the straight parts of the
/// pipe is U. Collective; throws Error(usage) where no cell is in the pipe.
void add_pipe_flow(Flow& flow, const PipeFlow& pipe);

}  // namespace snag
