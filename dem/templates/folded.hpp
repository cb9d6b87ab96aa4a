#pragma once
// A sheet folded like a fan: layers of equal length, one above the other, joined by bends that turn to either side by turns.
//
// The fold is that of a chain of rigid bonds of length 2 r. Particle i is turned by the angle theta_i about the fold's line, theta constant
// in a layer and growing by pi/m from particle to particle in a bend of m bonds; the bond between i and i + 1 points in the direction
// (theta_i + theta_{i+1})/2. So no bond is stretched or sheared and each bond of a bend is bent by the same angle pi/m: the bend of an
// inextensible strip. Layers are 2 r/sin(pi/(2 m)) apart; with m = 3 that is 4 r, a bend of radius 2 r, and layers do not touch.
//
// Folds in both directions at once cannot be made without stretching the cloth, so only one direction is folded.
#include <vector>

#include "dem/templates/lattice.hpp"

namespace snag {

/// Bonds of one bend, and distance of the layers over the particle radius.
inline constexpr int bonds_of_bend = 3;
inline constexpr double layer_distance_over_radius = 4;

/// Poses about the centre for the folds of piece.plan: the mean of the particles is at 0, the layers lie in planes of the piece's
/// orientation. Throws Error(usage) if both directions or none are to be folded, or a layer would be shorter than two particles.
std::vector<ParticlePose> folded_poses(const RagPiece& piece);

}  // namespace snag
