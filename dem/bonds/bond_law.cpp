#include "dem/bonds/bond_law.hpp"

#include "base/case_tables.hpp"

namespace snag {

Registry<BondLaw>& bond_laws() {
  static Registry<BondLaw> laws("bond law");
  return laws;
}

std::vector<Section> bond_law_sections() {
  // The records point into these laws: they live as long as the program.
  static const auto laws = bond_laws().make_all();
  std::vector<Section> sections;
  for (const auto& law : laws) {
    const BondLawDescription description = law->description();
    sections.push_back({"rag." + description.name,
                        "A `bond_law` of `[[rag]]`; of `[[disc]]` and `[[fibre]]` the table is `[disc." + description.name +
                            "]`, `[fibre." + description.name + "]`. " + description.equation + ". Source: " + description.source +
                            ". Valid for: " + description.valid_for + ".",
                        law->parameters()});
  }
  return sections;
}
const bool bond_law_tables = add_case_table(170, bond_law_sections);

std::unique_ptr<PieceBonds> bonds_of(const Rag& rag) {
  return rag.bond_law ? rag.bond_law->bonds(rag) : bond_laws().make(default_bond_law, rag.name)->bonds(rag);
}

}  // namespace snag
