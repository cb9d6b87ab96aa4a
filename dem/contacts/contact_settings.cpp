#include "dem/contacts/contact_settings.hpp"

#include "base/case_tables.hpp"

namespace snag {

Section ContactSettings::section() {
  const auto number = [](const char* key, double* target, double minimum, double maximum, Basis basis, const char* meaning) {
    return Parameter{.key = key, .target = target, .minimum = minimum, .maximum = maximum, .basis = basis, .meaning = meaning};
  };
  std::vector<Parameter> parameters{
      setting("law", &law_name, "Law of contact; the keys of the law are in a table of its name.", contact_laws().names()),
      setting("self_contact", &self_contact, "Contacts between the particles of one piece; false: its folds pass through each other."),
      setting("mutual_contact", &mutual_contact,
              "Contacts between particles of different pieces; false: one piece passes through another."),
      number("restitution", &restitution, 1e-6, 1, Basis::literature,
             "Speed after a normal impact over speed before, between particles (Jensen 2018, Table 3.2)."),
      number("static_friction", &static_friction, 0, 10, Basis::literature,
             "Coulomb coefficient between particles (Jensen 2018, Table 3.2)."),
      number("rolling_friction", &rolling_friction, 0, 1, Basis::literature,
             "Rolling torque over normal force and equivalent radius, between particles (Jensen 2018, Table 3.2)."),
      number("wall_restitution", &wall_restitution, 1e-6, 1, Basis::literature,
             "Speed after a normal impact over speed before, with walls (Jensen 2018, Table 3.2)."),
      number("wall_friction", &wall_friction, 0, 10, Basis::literature, "Coulomb coefficient with walls (Jensen 2018, Table 3.2)."),
      number("wall_rolling_friction", &wall_rolling_friction, 0, 1, Basis::literature,
             "Rolling torque over normal force and radius, with walls; no value is published, Table 3.2 of Jensen (2018) has it between "
             "particles only."),
      number("wall_stiffness_factor", &wall_stiffness_factor, 1e-3, 1e4, Basis::assumed,
             "Factor on the contact moduli E* and G* with walls; 1: the wall has the material of the particle. Stiffer walls need shorter "
             "steps."),
      number("skin_over_radius", &skin_over_radius, 1e-3, 10, Basis::assumed,
             "Margin of the lists of near particles over the largest radius. It changes the speed of the program, never a result."),
      Parameter{.key = "impact_speed",
                .target = &impact_speed,
                .unit = "m/s",
                .minimum = 1e-6,
                .maximum = 1000,
                .basis = Basis::assumed,
                .meaning = "Fastest impact that the sub-step must resolve: it sets the Hertz impact time."},
  };
  return {"contact", "Contacts of particles that are not bonded to each other, and with walls.", std::move(parameters)};
}
const bool contact_table = add_case_table<ContactSettings>(200);

void ContactSettings::read(const Table& contact) {
  contact.read(section().parameters);
  const std::shared_ptr<ContactLaw> chosen = contact_laws().make(law_name, contact.where() + " law");
  contact.table(law_name).read(chosen->parameters());
  law = chosen;
}

}  // namespace snag
