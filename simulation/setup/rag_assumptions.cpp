// Mass of the default cloth, soaked with a liquid of density rho:   m = m_f + (h - m_f/rho_f) rho
//   m_f = 0.060 kg/m2 of fibres, rho_f = 1380 kg/m3 (polyester), h = 0.77 mm the thickness;   0.785 kg/m2 with water of 998.2 kg/m3
#include "simulation/setup/rag_assumptions.hpp"

#include <cmath>

#include "base/words.hpp"
#include "dem/templates/rag_settings.hpp"

namespace snag {

namespace {

constexpr double fibre_mass = 0.060, fibre_density = 1380;  // kg/m2, kg/m3
constexpr double water_density = 998.2;                     // kg/m3
constexpr double noticeable = 0.02;                         // relative difference of densities

double soaked_mass(double thickness, double density) { return fibre_mass + (thickness - fibre_mass / fibre_density) * density; }

/// Bonds that were calibrated for another mass or thickness.
std::string bonds_of_another_cloth(const RagSettings& rag, const RagSettings& standard, const std::string& name) {
  if (!rag.passport.empty() || rag.properties != "published") return "";
  const bool same_mass = rag.mass_per_area == standard.mass_per_area || rag.has_published_density(),
             same_thickness = rag.thickness == standard.thickness;
  if (same_mass && same_thickness) return "";
  std::string text = name + " has mass_per_area = " + words(rag.mass_per_area) + " kg/m2 and thickness = " + words(1e3 * rag.thickness) +
                     " mm, but the bonds of the wet dust cloth of Jensen (2018), which has " + words(standard.mass_per_area) +
                     " kg/m2 and " + words(1e3 * standard.thickness) + " mm";
  if (same_mass != same_thickness && !rag.has_published_density())
    text += std::string("; its ") + (same_mass ? "mass" : "thickness") + " is the default one, too";
  return text + ". Give passport, or properties = \"custom\", for the bonds of another cloth";
}

/// A mass of cloth soaked with water, in another liquid.
std::string mass_of_another_liquid(const RagSettings& rag, const RagSettings& standard, const std::string& name, double liquid) {
  if (rag.has_published_density() || rag.mass_per_area != standard.mass_per_area ||
      std::abs(liquid - water_density) <= noticeable * water_density)
    return "";
  return name + " has mass_per_area = " + words(rag.mass_per_area) + " kg/m2, that of a cloth soaked with water of " +
         words(water_density) + " kg/m3; soaked with this liquid of " + words(liquid) + " kg/m3 it has " +
         words(soaked_mass(rag.thickness, liquid)) + " kg/m2. Give mass_per_area";
}

}  // namespace

std::vector<std::string> rag_assumptions(const CaseFile& resolved) {
  double liquid = water_density;
  const Table flow = resolved.root().table("flow");
  if (flow.present()) flow.read({{"density", &liquid, "kg/m3", 0, infinity, Basis::assumed, "Of the liquid."}});
  std::vector<std::string> lines;
  for (const auto& [shape, table_name] : {std::pair{RagSettings::Shape::rag, "rag"}, {RagSettings::Shape::disc, "disc"}}) {
    const RagSettings standard(shape);
    int number = 0;
    for (const Table& table : resolved.root().tables(table_name)) {
      RagSettings rag(shape);
      table.read(rag.section().parameters);
      const std::string name = "[[" + std::string(table_name) + "]] " + std::to_string(++number);
      for (const std::string& line : {bonds_of_another_cloth(rag, standard, name), mass_of_another_liquid(rag, standard, name, liquid)})
        if (!line.empty()) lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace snag
