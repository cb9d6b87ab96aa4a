#pragma once
// Force of the Hertz-Mindlin contact: equations and symbols in hertz_mindlin.cpp.
#include "dem/contacts/contact_blocks.hpp"

namespace snag {

inline const double hertz_damping = 2 * std::sqrt(5.0 / 6);

struct HertzMindlinForce {
  double normal = 0;              // 4/3 E* sqrt(R*), N/m^1.5
  double tangential = 0;          // 8 G* sqrt(R*), N/m^1.5
  double normal_damping = 0;      // N s/m^1.25
  double tangential_damping = 0;  // N s/m^1.25
  double easing = 0;              // of the tangential dashpot, 1/kg
  double friction = 0;            // mu

  explicit HertzMindlinForce(const ContactBodies& b) {
    const double damping = damping_of_restitution(b.restitution), root = std::sqrt(b.radius);
    normal = 4.0 / 3 * b.normal_modulus * root;
    tangential = 8 * b.shear_modulus * root;
    normal_damping = hertz_damping * damping * std::sqrt(2 * b.normal_modulus * root * b.mass);
    tangential_damping = hertz_damping * damping * std::sqrt(tangential * b.mass);
    easing = dashpot_easing(b.mass), friction = b.friction;
  }
  [[gnu::always_inline]] ContactForce operator()(const ContactMotion& contact, double step) const {
    const double root = std::sqrt(contact.overlap), quarter = std::sqrt(root);
    const double u_n = dot(contact.velocity, contact.normal);
    const double F_n = normal * root * contact.overlap + normal_damping * quarter * u_n;
    return with_friction(contact, F_n, tangential * root, eased(tangential_damping * quarter, easing, step), friction, step);
  }
  /// Of the springs and dashpots at this overlap, m, over the reduced mass m, kg, for steps up to `step`, s.
  ContactRates rates(double overlap, double m, double step) const {
    const double root = std::sqrt(overlap), quarter = std::sqrt(root);
    return {normal_rates(1.5 * normal * root, normal_damping * quarter, m),
            friction > 0 ? tangential_rates(tangential * root, tangential_damping * quarter, m, step) : StepRates{}};
  }
};

}  // namespace snag
