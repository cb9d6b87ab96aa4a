#include "dem/contacts/contact_pair.hpp"

#include <numbers>

namespace snag {

namespace {

double contact_compliance(const Rag& rag) { return (1 - rag.poisson_ratio) / (2 * rag.shear_modulus); }  // (1 - nu^2)/E
double shear_compliance(const Rag& rag) { return (2 - rag.poisson_ratio) / rag.shear_modulus; }

/// Two cloths of different friction: the geometric mean.
double friction_between(const Rag& a, const Rag& b, const ContactSettings& settings) {
  const double mu_a = a.cloth_friction.value_or(settings.static_friction), mu_b = b.cloth_friction.value_or(settings.static_friction);
  return mu_a == mu_b ? mu_a : std::sqrt(mu_a * mu_b);
}

std::shared_ptr<const PairLaw> law_between(const ContactBodies& bodies, const ContactSettings& settings) {
  return settings.law ? settings.law->between(bodies) : contact_laws().make(settings.law_name, "[contact] law")->between(bodies);
}

}  // namespace

ContactPair particle_pair(const Rag& a, const Rag& b, const ContactSettings& settings) {
  ContactPair pair;
  const double R = a.radius * b.radius / (a.radius + b.radius);
  pair.law = law_between({.normal_modulus = 1 / (contact_compliance(a) + contact_compliance(b)),
                          .shear_modulus = 1 / (shear_compliance(a) + shear_compliance(b)),
                          .radius = R,
                          .mass = a.mass * b.mass / (a.mass + b.mass),
                          .restitution = settings.restitution,
                          .friction = friction_between(a, b, settings)},
                         settings);
  pair.rolling = {settings.rolling_friction * R, a.inertia * b.inertia / (a.inertia + b.inertia)};
  pair.reach = a.layer_reach() + b.layer_reach();
  pair.share_1 = a.layer_reach() / pair.reach;
  pair.share_2 = b.layer_reach() / pair.reach;
  pair.radius_1 = a.radius, pair.radius_2 = b.radius;
  pair.cutoff = contact_distance(a, b);
  pair.smaller_reach = std::min(a.layer_reach(), b.layer_reach());
  return pair;
}

ContactPair wall_pair(const Rag& rag, const ContactSettings& settings) {
  ContactPair pair;
  pair.law = law_between({.normal_modulus = settings.wall_stiffness_factor / (2 * contact_compliance(rag)),
                          .shear_modulus = settings.wall_stiffness_factor / (2 * shear_compliance(rag)),
                          .radius = rag.radius,
                          .mass = rag.mass,
                          .restitution = settings.wall_restitution,
                          .friction = rag.wall_friction.value_or(settings.wall_friction),
                          .with_wall = true},
                         settings);
  pair.rolling = {settings.wall_rolling_friction * rag.radius, rag.inertia};
  pair.reach = pair.smaller_reach = rag.wall_reach();
  pair.share_1 = 1;
  pair.radius_1 = rag.radius;
  return pair;
}

double rayleigh_time(const Rag& rag) {
  const double density = rag.mass / (4.0 / 3 * std::numbers::pi * std::pow(rag.radius, 3));
  return std::numbers::pi * rag.radius * std::sqrt(density / rag.shear_modulus) / (0.1631 * rag.poisson_ratio + 0.8766);
}

}  // namespace snag
