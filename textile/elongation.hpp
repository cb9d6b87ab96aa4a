#pragma once
// The elongation test: two clamps pull a cloth apart (grab test; Jensen 2018, sections 2.2.1 and 3.3.1).
//
//   n   = width/(2 r_p)                              columns of particles that the clamps grip
//   S_n = F/(n strain 2 r_p A),  sigma_c = F/(n A)   A = pi r_p^2                                             [Eqs. 3.25 - 3.31]
//
// Both clamps grip the same cloth: `width` is that of one. The published calibration counts both, 0.2 m for clamps of 0.1 m, so its
// stiffness and strength are half of what was measured.
#include <vector>

#include "dem/templates/rag_settings.hpp"
#include "textile/textile_tests.hpp"

namespace snag {

/// Sets the normal stiffness and strength of the bonds of one direction; the others stay zero. `as_published`: clamps counted twice.
BondProperties elongation_bond(const TextileTests& tests, int direction, double radius, bool as_published);

struct GrabTest {
  std::vector<double> strain, force;  // 1, N: of the clamp at rest
  double max_force = 0;               // N
  double strain_at_max = 0;
};

/// The test by the motion of the bonded particles: the cloth between two clamps, which part until the force has fallen to half. The cloth
/// beside the clamps is left out: it would carry little, but drag at the clamps' corners, where bonds that do not yield would tear before
/// the cloth does (at 1.5 mm lengthwise at 140 N instead of 172 N). `bond`: both directions, [0] the one that is pulled. `share`: of the
/// stable step. On this rank alone.
GrabTest simulated_grab_test(const TextileTests& tests, int direction, double radius, const std::array<BondProperties, 2>& bond,
                             double share = DemSettings{}.safety);

}  // namespace snag
