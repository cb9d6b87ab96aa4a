#include "dem/contacts/contact_law.hpp"

#include <numbers>

#include "base/case_tables.hpp"

namespace snag {

Registry<ContactLaw>& contact_laws() {
  static Registry<ContactLaw> laws("contact law");
  return laws;
}

double damping_of_restitution(double restitution) {
  const double logarithm = std::log(restitution);
  return -logarithm / std::sqrt(logarithm * logarithm + std::numbers::pi * std::numbers::pi);
}

double PairLaw::stable_step(double speed) const {
  const double resolved = impact_time(speed) / impact_steps;
  const ContactRates deepest = rates(deepest_overlap(speed), resolved);
  return std::min({resolved, deepest.normal.step(), (turning_sphere * deepest.tangential).step()});
}

std::vector<Section> contact_law_sections() {
  // The records point into these laws: they live as long as the program.
  static const auto laws = contact_laws().make_all();
  std::vector<Section> sections;
  for (const auto& law : laws) {
    const ContactLawDescription description = law->description();
    sections.push_back({"contact." + description.name,
                        "A `law` of `[contact]`. " + description.equation + ". Source: " + description.source +
                            ". Valid for: " + description.valid_for + ".",
                        law->parameters()});
  }
  return sections;
}
const bool contact_law_tables = add_case_table(220, contact_law_sections);

}  // namespace snag
