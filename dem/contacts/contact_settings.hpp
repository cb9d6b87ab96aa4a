#pragma once
// Settings of contacts, table [contact] of the case file.
#include <memory>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/parameter.hpp"
#include "dem/contacts/contact_law.hpp"

namespace snag {

struct ContactSettings {
  std::string law_name = default_contact_law;
  std::shared_ptr<const ContactLaw> law;  // with its own parameters; none: `law_name` with their defaults
  bool self_contact = true;               // of particles of one piece with each other
  bool mutual_contact = true;             // of particles of different pieces
  double restitution = 0.01;              // e, of normal impact
  double static_friction = 0.5;           // mu, Coulomb
  double rolling_friction = 0.01;         // mu_r, between particles
  double wall_restitution = 0.01;
  double wall_friction = 0.5;
  double wall_rolling_friction = 0;
  double wall_stiffness_factor = 1;  // multiplies E* and G* of contacts with walls
  double skin_over_radius = 0.5;     // of the largest particle
  double impact_speed = 5;           // m/s, for stable_step

  /// The table; its records refer to this object.
  Section section();
  /// Reads the table and that of the chosen law.
  void read(const Table& contact);
};

}  // namespace snag
