#pragma once
// The bending test: a strip pushed over an edge until its tip touches a plane that falls from the edge at 41.3 degrees (Peirce 1930, DIN
// 53362; Jensen 2018, section 2.2.2), and the bending stiffness that makes a chain of particles do the same.
//
// The chain: particle 0 is held at the edge, flat; particles 1 .. n hang over it under their own weight, 2 r_p apart. Each stands for the
// cloth within r_p along the strip, so the last one for the part of its cell that is left of the overhang L,
//   n = ceil(L/(2 r_p) - 1/2),      share of the last cell phi = L/(2 r_p) - n + 1/2,
// whose weight acts at the middle of that part; the tip lies L - 2 r_p n beyond the last centre along its lattice direction. So the
// criterion is continuous in L, and the error is of second order in r_p/L.
#include <vector>

#include "base/vec3.hpp"
#include "textile/textile_tests.hpp"

namespace snag {

/// A strip over an edge at the origin; x out, z up.
struct Strip {
  double radius = 0;         // r_p, m
  double overhang = 0;       // L, m
  double mass_per_area = 0;  // kg/m2
  BondProperties bond;       // along the strip
};

Strip strip_of(const TextileTests& tests, int direction, double radius, const BondProperties& bond);

struct StripShape {
  std::vector<Vec3> centres;  // of particles 0 .. n, m
  Vec3 tip;                   // m
};

/// The strip at rest. Throws Error(usage) if the overhang holds no particle, Error(diverged) if it does not come to rest.
StripShape hanging_strip(const Strip& strip);

/// The strip after `duration` s of its own motion from flat, with dashpots in its bonds (c_d) in air that slows it by `air` (1/s), in
/// steps of a `share` of the stable one.
StripShape moved_strip(const Strip& strip, double bond_damping, double duration, double air, double share);

/// Distance of the tip from the plane that falls at `angle` (rad) from the edge; positive above it, m.
double height_above_plane(const Vec3& tip, double angle);

/// Bending stiffness S_nb (N/m3) at which the tip is on the plane to 0.01 mm, by bracketing (TOMS 748). The bond's other properties
/// stay. Throws Error(usage) if no stiffness does it.
double bending_stiffness_to_plane(Strip strip, double angle);

}  // namespace snag
