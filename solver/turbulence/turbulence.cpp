#include "solver/turbulence/turbulence.hpp"

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

struct Heading {
  std::string model = "laminar";
  std::vector<Parameter> parameters() {
    return {setting("model", &model, "How the effect of eddies smaller than the mean flow is described.", turbulence_models().names())};
  }
};

}  // namespace

SweepReport TurbulenceReport::of(std::string_view symbol) const {
  for (const Equation& equation : equations)
    if (equation.symbol == symbol) return equation.sweeps;
  return {};
}

int TurbulenceReport::sweeps() const {
  int n = 0;
  for (const Equation& equation : equations) n += equation.sweeps.sweeps;
  return n;
}

void Turbulence::refuse_rough_walls(const Flow& flow, const BoundarySet& boundary) {
  for (int p = 0; p < static_cast<int>(flow.mesh.patches.size()); ++p)
    if (boundary.roughness(p) > 0)
      throw Error(ExitCode::usage, boundary.where(p) + ": roughness_height = " + number_text(boundary.roughness(p)) + " m at patch \"" +
                                       flow.mesh.patches[p].name + "\", but the turbulence model \"" + section().name +
                                       "\" has no law for rough walls; take k_epsilon or realizable_k_epsilon, or a height of 0");
}

Registry<Turbulence>& turbulence_models() {
  static Registry<Turbulence> registry("turbulence model");
  return registry;
}

std::unique_ptr<Turbulence> read_turbulence(const Table& root) {
  const Table table = root.table("turbulence");
  Heading heading;
  table.read(heading.parameters());
  auto model = turbulence_models().make(heading.model, table.where());
  table.read(model->section().parameters);
  return model;
}

std::vector<Section> turbulence_sections() {
  // The records point into these: they live as long as the program.
  static Heading heading;
  static std::vector<std::unique_ptr<Turbulence>> models;
  models.clear();
  std::vector<Section> sections{{.name = "turbulence", .meaning = "Turbulence of the water.", .parameters = heading.parameters()}};
  for (const std::string& name : turbulence_models().names()) {
    models.push_back(turbulence_models().make(name, "manual"));
    Section section = models.back()->section();
    section.meaning = "model = \"" + name + "\": " + section.meaning;
    section.name = "turbulence";
    sections.push_back(section);
  }
  return sections;
}
const bool turbulence_tables = add_case_table(80, turbulence_sections);

}  // namespace snag
