#pragma once
// Rest without waiting for it: dynamic relaxation with kinetic damping.
//
// The motion is that of dem/particles/integrator.hpp; each time the kinetic energy has passed a peak all velocities are set to zero. At a
// peak the cloth is near an equilibrium of its slowest mode, so that a few peaks bring it to rest, where a real cloth would swing for
// seconds. Forces at rest do not depend on masses, dashpots or rotation friction, so the equilibria are those of the dynamic run; friction
// at contacts acts as in it.
//
// Rest: the kinetic energy of a peak is what the potential energy fell by since the peak before. A particle of weight w that is u away from
// rest, held by gravity at a length l (a pendulum), has w u^2/(2 l) to lose. The cloth is at rest when two peaks in a row have less than
// that for each particle.
//
// Source: Barnes, M. R. (1999), Form finding and analysis of tension structures by dynamic relaxation, Int. J. Space Structures 14, 89-104.
#include "dem/rag_system.hpp"

namespace snag {

inline constexpr double standard_gravity = 9.81;  // m/s2

struct Relaxation {
  double gravity = standard_gravity;  // m/s2, of the weight in the measure of rest
  double length = 0;                  // l, m
  double tolerance = 0;               // u, m
  double longest_time = 20;           // of the motion, s
  int steps_between_looks = 20;       // at the kinetic energy
};

/// What a relaxation took.
struct RelaxationCost {
  int n_peaks = 0;
  double time = 0;  // of the motion, s
  std::int64_t n_steps = 0;
};

/// A piece with the light dashpots of a relaxation instead of its own: they take out the ripple of stretched bonds, which would hide the
/// peaks of the slow motion.
RagPiece relaxing(const RagPiece& piece);

/// Moves free particles until they rest. `rags` on one rank. Throws Error(diverged) if they do not within the longest time.
RelaxationCost relax(RagSystem& rags, const Relaxation& settings, TileForce* force = nullptr);

}  // namespace snag
