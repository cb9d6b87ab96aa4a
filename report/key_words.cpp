#include "report/key_words.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <vector>

#include "base/units.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

/// Keys of the tables of summary.json, without the number of a rag.
const std::map<std::string, KeyWords>& known_words() {
  static const std::map<std::string, KeyWords> words = {
      {"exit", {"Exit code", ""}},
      {"wall_s", {"Computing time", "s"}},
      {"simulated_s", {"Simulated time", "s"}},
      {"time_steps", {"Time steps", ""}},
      {"ranks", {"MPI ranks", ""}},
      {"mesh.cells", {"Cells", ""}},
      {"mesh.min_quality", {"Lowest cell quality", ""}},
      {"pump.flow_m3_s", {"Flow rate", "m3/s"}},
      {"pump.head_m", {"Head", "m"}},
      {"pump.head_total_m", {"Total head", "m"}},
      {"pump.torque_Nm", {"Torque", "N m"}},
      {"pump.shaft_power_W", {"Shaft power", "W"}},
      {"pump.efficiency", {"Efficiency", ""}},
      {"pump.revolutions", {"Revolutions", ""}},
      {"rags.outcome", {"Outcome", ""}},
      {"rags.retention_time_s", {"Retention time", "s"}},
      {"rags.time_to_enter_s", {"Time to enter", "s"}},
      {"rags.stuck_on_tongue_s", {"Time stuck on the tongue", "s"}},
      {"rags.stuck_on_impeller_s", {"Time stuck on the impeller", "s"}},
      {"rags.first_contact_s", {"First contact with a wall", "s"}},
      {"rags.before_contact.duration_s", {"Time before contact", "s"}},
      {"rags.before_contact.path_m", {"Path before contact", "m"}},
      {"rags.before_contact.impulse_N_s.0", {"Impulse of the water along x before contact", "N s"}},
      {"rags.before_contact.impulse_N_s.1", {"Impulse of the water along y before contact", "N s"}},
      {"rags.before_contact.impulse_N_s.2", {"Impulse of the water along z before contact", "N s"}},
      {"rags.before_contact.mean_force_N.0", {"Mean force of the water along x before contact", "N"}},
      {"rags.before_contact.mean_force_N.1", {"Mean force of the water along y before contact", "N"}},
      {"rags.before_contact.mean_force_N.2", {"Mean force of the water along z before contact", "N"}},
      {"coupling.force_share_at_walls", {"Share of the force in cells at walls", ""}},
      {"coupling.force_displacement_m", {"Displacement of the force on the water", "m"}},
      {"coupling.couple_lost_rel", {"Couple lost in the exchange, relative", ""}},
      {"coupling.kernel_width_over_cell_least", {"Least kernel width / cell size", ""}},
      {"coupling.max_solid_fraction", {"Largest solid fraction", ""}},
      {"conservation.momentum_exchange_rel", {"Momentum lost in the exchange, relative", ""}},
      {"rags.wall_contact_s", {"Time in contact with walls", "s"}},
      {"rags.elongation_ratio", {"Elongation ratio at the end", ""}},
      {"rags.elongation_ratio_at_start", {"Initial elongation ratio", ""}},
      {"rags.projected_area_m2", {"Projected area", "m2"}},
      {"rags.bond_strain_p99", {"Bond strain (99th percentile)", ""}},
      {"rags.max_bond_tension_N", {"Largest bond tension", "N"}},
      {"rags.max_wall_overlap_over_radius", {"Deepest wall overlap / radius", ""}},
  };
  return words;
}

std::string capitalised(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// The longest ending of a word that is a unit is taken off.
KeyWords without_unit(const std::string& word) {
  for (std::size_t at = word.find('_'); at != std::string::npos; at = word.find('_', at + 1)) {
    const std::string unit = word.substr(at + 1) == "Nm" ? "N m" : unit_of_suffix(word.substr(at + 1));
    if (parse_unit(unit)) return {capitalised(word.substr(0, at)), unit};
  }
  return {capitalised(word), ""};
}

}  // namespace

KeyWords words_of_key(const std::string& key) {
  std::vector<std::string> parts = split(key, '.');
  std::string of_rag;
  if (parts.size() > 2 && parts[0] == "rags") {
    if (parts[1] != "0") of_rag = ", rag " + parts[1];
    parts.erase(parts.begin() + 1);
  }
  std::string plain;
  for (const std::string& part : parts) plain += (plain.empty() ? "" : ".") + part;
  const auto found = known_words().find(plain);
  KeyWords words = found == known_words().end() ? without_unit(parts.back()) : found->second;
  words.title += of_rag;
  return words;
}

}  // namespace snag
