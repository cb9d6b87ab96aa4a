// Heading of a log. It names what a case takes over from the default cloth although it changes a part of it: bonds, mass and liquid belong
// together.
//
// Mass of the default cloth, soaked with a liquid of density rho:   m = m_f + (h - m_f/rho_f) rho
//   m_f = 0.060 kg/m2 of fibres, rho_f = 1380 kg/m3 (polyester), h = 0.77 mm the thickness;   0.785 kg/m2 with water of 998.2 kg/m3
#include "simulation/setup/heading.hpp"

#include <cmath>
#include <sstream>

#include "base/log.hpp"
#include "base/version.hpp"
#include "base/words.hpp"
#include "dem/templates/rag_settings.hpp"
#include "parallel/session.hpp"
#include "simulation/setup/forecast.hpp"
#include "simulation/setup/gap_lines.hpp"
#include "solver/pump_monitor.hpp"

namespace snag {

namespace {

constexpr double fibre_mass = 0.060, fibre_density = 1380;  // kg/m2, kg/m3
constexpr double water_density = 998.2;                     // kg/m3
constexpr double noticeable = 0.02;                         // relative difference of densities

double soaked_mass(double thickness, double density) { return fibre_mass + (thickness - fibre_mass / fibre_density) * density; }

/// Bonds that were calibrated for another mass or thickness.
std::string bonds_of_another_cloth(const RagSettings& rag, const RagSettings& standard, const std::string& name) {
  if (!rag.passport.empty() || rag.properties != RagSettings::Properties::published) return "";
  const bool same_mass = rag.mass_per_area == standard.mass_per_area || rag.has_published_density(),
             same_thickness = rag.thickness == standard.thickness;
  if (same_mass && same_thickness) return "";
  std::string text = name + " has mass_per_area = " + number_text(rag.mass_per_area) +
                     " kg/m2 and thickness = " + number_text(1e3 * rag.thickness) +
                     " mm, but the bonds of the wet dust cloth of Jensen (2018), which has " + number_text(standard.mass_per_area) +
                     " kg/m2 and " + number_text(1e3 * standard.thickness) + " mm";
  if (same_mass != same_thickness && !rag.has_published_density())
    text += std::string("; its ") + (same_mass ? "mass" : "thickness") + " is the default one, too";
  return text + ". Give passport, or properties = \"custom\", for the bonds of another cloth";
}

/// A mass of cloth soaked with water, in another liquid.
std::string mass_of_another_liquid(const RagSettings& rag, const RagSettings& standard, const std::string& name, double liquid) {
  if (rag.has_published_density() || rag.mass_per_area != standard.mass_per_area ||
      std::abs(liquid - water_density) <= noticeable * water_density)
    return "";
  return name + " has mass_per_area = " + number_text(rag.mass_per_area) + " kg/m2, that of a cloth soaked with water of " +
         number_text(water_density) + " kg/m3; soaked with this liquid of " + number_text(liquid) + " kg/m3 it has " +
         number_text(soaked_mass(rag.thickness, liquid)) + " kg/m2. Give mass_per_area";
}

/// A line for each assumption; none for the cloth as it stands, soaked with water. `root`: of a case that has been read.
std::vector<std::string> rag_assumptions(const Table& root) {
  double liquid = water_density;
  const Table flow = root.table("flow");
  if (flow.present()) flow.read({{"density", &liquid, "kg/m3", 0, infinity, Basis::assumed, "Of the liquid."}});
  std::vector<std::string> lines;
  for (const auto& [shape, table_name] : {std::pair{RagSettings::Shape::rag, "rag"}, {RagSettings::Shape::disc, "disc"}}) {
    const RagSettings standard(shape);
    int number = 0;
    for (const Table& table : root.tables(table_name)) {
      RagSettings rag(shape);
      table.read(rag.section().parameters);
      const std::string name = "[[" + std::string(table_name) + "]] " + std::to_string(++number);
      for (const std::string& line : {bonds_of_another_cloth(rag, standard, name), mass_of_another_liquid(rag, standard, name, liquid)})
        if (!line.empty()) lines.push_back(line);
    }
  }
  return lines;
}

/// The sub-step of the rags and what limits it.
std::string sub_step_words(const RagSystem& rags) {
  const double step = rags.stable_step(), limit = rags.step_limit().step;
  return (std::isfinite(step) ? "sub-step " + number_text(step) + " s" : "no sub-steps") +
         (std::isfinite(limit) ? " (limit " + number_text(limit) + " s by " + rags.step_limit().reason + ")"
                               : " (neither bonds nor contacts limit the step)");
}

bool water_has_walls(const Simulation& simulation) {
  if (!simulation.water) return false;
  for (int patch = 0; patch < static_cast<int>(simulation.mesh->patches.size()); ++patch)
    if (simulation.water->boundary().is_wall(patch)) return true;
  return false;
}

/// Warnings of rags that start faster than their sub-steps allow for, and of rags in periodic meshes.
std::vector<std::string> rag_warnings(const Simulation& simulation) {
  std::vector<std::string> warnings;
  if (!simulation.rags) return warnings;
  const double impact = simulation.contacts.impact_speed;
  std::int64_t n_fast = 0;
  const RagPiece* fastest = nullptr;
  for (const RagPiece& piece : simulation.rags->pieces()) {
    n_fast += norm(piece.velocity) > impact;
    if (!fastest || norm(piece.velocity) > norm(fastest->velocity)) fastest = &piece;
  }
  if (n_fast > 0)
    warnings.push_back((n_fast == 1 ? "" : counted(n_fast, "piece") + " start too fast, the fastest: ") + fastest->rag.name +
                       " starts at " + rounded(norm(fastest->velocity)) + " m/s, faster than [contact] impact_speed, " + rounded(impact) +
                       " m/s, for which the sub-step and the stiffness of contacts are chosen; give impact_speed that speed");
  if (simulation.is_periodic() && simulation.mesh)
    warnings.emplace_back("rags are not carried through [[periodic]] patches: the run ends with code 5 where one gets there");
  return warnings;
}

}  // namespace

void log_heading(const Simulation& simulation, const CaseFile& file) {
  std::ostringstream text;
  text << "snag " << version_number << " (" << version_git << "), " << version_build << "\n"
       << "case " << simulation.case_settings.name << ", sha256 " << file.sha256() << ", " << counted(size_of(MPI_COMM_WORLD), "rank")
       << "\n";
  if (simulation.mesh)
    text << "mesh: " << simulation.mesh->n_cells_global << " cells, " << simulation.mesh->n_interior_global << " interior faces\n";
  if (simulation.rags) {
    text << "rags: " << counted(static_cast<std::int64_t>(simulation.rags->rags().size()), "piece") << " with "
         << counted(simulation.rags->n_particles(), "particle") << ", " << sub_step_words(*simulation.rags) << "\n";
  }
  log::info(text.str());
  for (const std::string& line : rag_assumptions(file.root())) log::info("assumed: " + line);
  if (simulation.coupled && simulation.mesh) {
    const std::string width = assumed_kernel_width(simulation.coupled->coupling(), simulation.rags->rags());
    if (!width.empty()) log::info("assumed: " + width);
  }
  if (simulation.coupled)
    for (const std::string& line : left_out_added_mass(simulation.coupled->coupling(), simulation.rags->rags()))
      log::info("left out: " + line);
  if (simulation.poses)
    for (const std::string& line : simulation.poses->lines()) log::info(line);
  if (simulation.holds)
    for (const std::string& line : simulation.holds->lines()) log::info(line);
  if (simulation.rags && rank_of(MPI_COMM_WORLD) == 0)
    for (const std::string& line : gap_lines(simulation.walls, simulation.rags->rags(), simulation.contacts, simulation.time()))
      log::info(line);
  for (const std::string& warning : rag_warnings(simulation)) log::warning(warning);
  if (simulation.pump)
    for (const std::string& warning : pump_warnings(simulation.water->flow, *simulation.pump)) log::warning(warning);
  if (simulation.coupled)
    for (const std::string& warning :
         wall_warnings(simulation.coupled->coupling(), !simulation.walls.bodies().empty(), water_has_walls(simulation)))
      log::warning(warning);
  if (simulation.coupled) {
    const std::string undragged = undragged_warning(simulation.coupled->coupling(), simulation.rags->rags());
    if (!undragged.empty()) log::warning(undragged);
  }
  if (simulation.coupled && simulation.mesh) {
    for (const std::string& warning :
         kernel_warnings(simulation.coupled->coupling(), simulation.rags->rags(), *simulation.mesh, places_of_cloth(simulation)))
      log::warning(warning);
    const Flow& flow = simulation.water->flow;
    const std::string of_step = viscous_step_warning(simulation.coupled->coupling(), simulation.rags->rags(), simulation.time_settings.step,
                                                     flow.dynamic_viscosity / flow.density);
    if (!of_step.empty()) log::warning(of_step);
  }
}

}  // namespace snag
