#include "dem/contacts/contact_law.hpp"

#include <numbers>

namespace snag {

Registry<ContactLaw>& contact_laws() {
  static Registry<ContactLaw> laws("contact law");
  return laws;
}

double damping_of_restitution(double restitution) {
  const double logarithm = std::log(restitution);
  return -logarithm / std::sqrt(logarithm * logarithm + std::numbers::pi * std::numbers::pi);
}

double spring_limit(double stiffness, double mass, double damping, double q) {
  const double omega = std::sqrt(stiffness * q / mass), zeta = damping * std::sqrt(q);
  return 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
}

std::vector<Section> contact_law_sections() {
  // The records point into these laws: they live as long as the program.
  static const auto laws = contact_laws().make_all();
  std::vector<Section> sections;
  for (const auto& law : laws) {
    const ContactCard card = law->card();
    sections.push_back({"contact." + card.name,
                        "A `law` of `[contact]`. " + card.equation + ". Source: " + card.source + ". Valid for: " + card.valid_for + ".",
                        law->parameters()});
  }
  return sections;
}

}  // namespace snag
