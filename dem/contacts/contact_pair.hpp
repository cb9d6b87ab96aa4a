#pragma once
// What a pair of bodies in contact has in common: its law, geometry, rolling friction.
//
//   Rayleigh time (of a surface wave along a particle)   T_R = pi r sqrt(rho/G) / (0.1631 nu + 0.8766)      Thornton (2015)
#include <memory>

#include "dem/contacts/contact_blocks.hpp"
#include "dem/contacts/contact_settings.hpp"
#include "dem/particles/rag.hpp"

namespace snag {

/// A pair of particles, or a particle and a wall.
struct ContactPair {
  std::shared_ptr<const PairLaw> law;
  RollingFriction rolling;
  double reach = 0;  // distance of the surfaces below which they touch: l_1 + l_2, or l_1 of a wall, m (l: Rag::layer_reach, wall_reach)
  double share_1 = 0, share_2 = 0;    // of the distance of the surfaces, where the contact point lies: l_1/(l_1 + l_2), l_2/(l_1 + l_2)
  double radius_1 = 0, radius_2 = 0;  // r_p, m
  double cutoff = 0;                  // distance of the centres beyond which they never touch, m
  double smaller_reach = 0;           // of l_1, l_2, m
};

// The surface of cloth lies half its contact thickness from the particles, which are cells of the cloth, (2 r_p)^2 wide: that thickness
// says where a contact begins, while stiffness, mass and with them the stable step stay those of the particle.

/// Contact of a particle of rag `a` (1) with one of rag `b` (2).
ContactPair particle_pair(const Rag& a, const Rag& b, const ContactSettings& settings);
/// Contact of a particle (1) with a wall (2): a body of the particle's material, flat and at rest, E* and G* multiplied by
/// wall_stiffness_factor.
ContactPair wall_pair(const Rag& rag, const ContactSettings& settings);

double rayleigh_time(const Rag& rag);  // s

}  // namespace snag
