#include "dem/contacts/contact_pair.hpp"

#include <numbers>

namespace snag {

namespace {

constexpr double impact_steps = 8;      // sub-steps that resolve an impact: restitution then holds to some percent
constexpr double turning_sphere = 3.5;  // 1 + m r^2 / I of a solid sphere
const double damping_factor = 2 * std::sqrt(5.0 / 6);

/// Coefficients from the equivalent moduli E*, G* (Pa), radius (m) and mass (kg).
HertzMindlin coefficients(double E, double G, double R, double m, double damping) {
  HertzMindlin law;
  law.normal = 4.0 / 3 * E * std::sqrt(R);
  law.tangential = 8 * G * std::sqrt(R);
  law.normal_damping = damping_factor * damping * std::sqrt(2 * E * std::sqrt(R) * m);
  law.tangential_damping = damping_factor * damping * std::sqrt(law.tangential * m);
  return law;
}

double contact_compliance(const Rag& rag) { return (1 - rag.poisson_ratio) / (2 * rag.shear_modulus); }  // (1 - nu^2)/E
double shear_compliance(const Rag& rag) { return (2 - rag.poisson_ratio) / rag.shear_modulus; }

/// k of the impact formulas: F_n = 5/4 k d^(3/2).
double impact_stiffness(const ContactPair& pair) { return 0.8 * pair.law.normal; }

double spring_limit(double stiffness, double mass, double damping, double q) {
  const double omega = std::sqrt(stiffness * q / mass), zeta = std::sqrt(5.0 / 6) * damping * std::sqrt(q);
  return 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
}

}  // namespace

double damping_of_restitution(double restitution) {
  const double logarithm = std::log(restitution);
  return -logarithm / std::sqrt(logarithm * logarithm + std::numbers::pi * std::numbers::pi);
}

ContactPair particle_pair(const Rag& a, const Rag& b, const ContactSettings& settings) {
  ContactPair pair;
  const double R = a.radius * b.radius / (a.radius + b.radius);
  const double E = 1 / (contact_compliance(a) + contact_compliance(b)), G = 1 / (shear_compliance(a) + shear_compliance(b));
  pair.equivalent_mass = a.mass * b.mass / (a.mass + b.mass);
  pair.damping = damping_of_restitution(settings.restitution);
  pair.law = coefficients(E, G, R, pair.equivalent_mass, pair.damping);
  pair.law.friction = settings.static_friction;
  pair.rolling = {settings.rolling_friction * R, a.inertia * b.inertia / (a.inertia + b.inertia)};
  pair.reach = a.radius + b.radius;
  pair.arm_1 = a.radius / pair.reach;
  pair.arm_2 = b.radius / pair.reach;
  pair.smaller_radius = std::min(a.radius, b.radius);
  return pair;
}

ContactPair wall_pair(const Rag& rag, const ContactSettings& settings) {
  ContactPair pair;
  const double E = settings.wall_stiffness_factor / (2 * contact_compliance(rag)),
               G = settings.wall_stiffness_factor / (2 * shear_compliance(rag));
  pair.equivalent_mass = rag.mass;
  pair.damping = damping_of_restitution(settings.wall_restitution);
  pair.law = coefficients(E, G, rag.radius, rag.mass, pair.damping);
  pair.law.friction = settings.wall_friction;
  pair.rolling = {settings.wall_rolling_friction * rag.radius, rag.inertia};
  pair.reach = pair.smaller_radius = rag.radius;
  pair.arm_1 = 1;
  return pair;
}

double rayleigh_time(const Rag& rag) {
  const double density = rag.mass / (4.0 / 3 * std::numbers::pi * std::pow(rag.radius, 3));
  return std::numbers::pi * rag.radius * std::sqrt(density / rag.shear_modulus) / (0.1631 * rag.poisson_ratio + 0.8766);
}

double hertz_time(const ContactPair& pair, double speed) { return 2.943175 * hertz_overlap(pair, speed) / speed; }

double hertz_overlap(const ContactPair& pair, double speed) {
  return std::pow(pair.equivalent_mass * speed * speed / impact_stiffness(pair), 0.4);
}

double stable_contact_step(const ContactPair& pair, double speed) {
  const double root = std::sqrt(hertz_overlap(pair, speed));
  const double normal = spring_limit(1.5 * pair.law.normal * root, pair.equivalent_mass, pair.damping, 1);
  const double tangential =
      pair.law.friction > 0 ? spring_limit(pair.law.tangential * root, pair.equivalent_mass, pair.damping, turning_sphere) : normal;
  return std::min({hertz_time(pair, speed) / impact_steps, normal, tangential});
}

}  // namespace snag
