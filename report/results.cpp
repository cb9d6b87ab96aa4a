#include "report/results.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/progress.hpp"
#include "base/words.hpp"
#include "observe/outcome.hpp"
#include "report/html.hpp"
#include "simulation/setup/checks.hpp"

namespace snag {

namespace {

using nlohmann::json;
using Rows = std::vector<std::vector<std::string>>;

/// Member of a table, or null.
const json& member(const json& table, const std::string& key) {
  static const json none;
  return table.is_object() && table.contains(key) ? table[key] : none;
}

double real(const json& table, const std::string& key) {
  const json& value = member(table, key);
  return value.is_number() ? value.get<double>() : NAN;
}

/// A text, "" where it is none.
std::string word(const json& table, const std::string& key) {
  const json& value = member(table, key);
  return value.is_string() ? value.get<std::string>() : "";
}

std::string text_of(const json& value) {
  if (value.is_number_integer()) return html::count(value.get<std::int64_t>());
  if (value.is_number()) return html::number(value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return escaped(value.get<std::string>());
  return escaped(value.dump());
}

struct Named {
  const char* key;
  const char* meaning;
  const char* unit;
};

/// Rows of the known keys in this order, then those that nobody has named yet; nested tables and lists are left out.
void add_rows(Rows& rows, const json& table, const std::vector<Named>& names, bool with_rest = true) {
  if (!table.is_object()) return;
  for (const auto& named : names)
    if (const json& value = member(table, named.key); !value.is_null())
      rows.push_back({named.meaning, text_of(value) + (*named.unit ? " " : "") + named.unit});
  if (!with_rest) return;
  for (const auto& [key, value] : table.items()) {
    bool is_known = value.is_structured() || value.is_null();
    for (const auto& named : names) is_known = is_known || key == named.key;
    if (!is_known) rows.push_back({escaped(key), text_of(value)});
  }
}

std::string table_of(const std::vector<std::string>& header, const Rows& rows) { return rows.empty() ? "" : html::table(header, rows); }

const char* exit_words(int code) {
  switch (code) {
    case 0:
      return "The run ended as planned.";
    case 2:
      return "The run was refused because of its case file.";
    case 3:
      return "The run was refused because of its mesh.";
    case 4:
      return "The computation diverged: its results must not be used.";
    case 5:
      return "Particles, bonds or momentum were lost, or went through walls: the results must not be used.";
    case 6:
      return "The run was stopped because a file could not be read or written.";
    case 7:
      return "The run was stopped on request; a checkpoint is written and it can be resumed.";
    default:
      return "The run was stopped by an error.";
  }
}

std::string rag_words(const std::string& outcome) {
  const std::optional<Outcome> known = outcome_named(outcome);
  return known ? words_of(*known).now : "ended as \"" + escaped(outcome) + "\"";
}

/// Rag 0, or Rag "wipe" where it has a name of its own.
std::string name_of(const json& rag) {
  const std::string name = word(rag, "name");
  if (name.starts_with("rag")) return "R" + escaped(name.substr(1));
  if (!name.empty()) return "Rag &quot;" + escaped(name) + "&quot;";
  const json& id = member(rag, "id");
  return id.is_null() ? "The rag" : "Rag " + text_of(id);
}

std::string rags_sentence(const json& rags) {
  if (!rags.is_array() || rags.empty()) return "";
  std::string text;
  if (rags.size() <= 3) {
    for (const auto& rag : rags) {
      text += " " + name_of(rag) + " " + rag_words(word(rag, "outcome")) + ".";
      if (const double broken = real(rag, "broken_bonds"); broken > 0)
        text += " It has " + html::count(std::llround(broken)) + " broken bonds.";
    }
    return text;
  }
  std::map<std::string, int> counts;
  for (const auto& rag : rags) ++counts[word(rag, "outcome")];
  text = " Of " + std::to_string(rags.size()) + " rags";
  std::string separator = ": ";
  for (const auto& [outcome, n] : counts) {
    text += separator + std::to_string(n) + " " + (n == 1 ? "" : "each ") + rag_words(outcome);
    separator = "; ";
  }
  return text + ".";
}

}  // namespace

bool ended_well(const json& summary) {
  const std::vector<CheckedValue> all = checked(summary);
  return real(summary, "exit") == 0 && std::none_of(all.begin(), all.end(), [](const CheckedValue& one) { return one.fails(); });
}

std::string outcome_sentence(const json& summary, const std::string& verdict) {
  const double code = real(summary, "exit"), simulated = real(summary, "simulated_s"), steps = real(summary, "time_steps");
  std::string text = std::isnan(code) ? "The run left no exit code." : exit_words(static_cast<int>(code));
  if (code == 0 && !ended_well(summary)) text = "The run reached its end, but its results must not be used.";
  if (const std::string error = word(summary, "error"); !error.empty()) text += " " + escaped(error) + ".";
  for (const CheckedValue& one : checked(summary))
    if (one.fails()) text += " Check failed: " + escaped(failure_in_words(one)) + ".";
  if (std::isfinite(simulated)) text += " It covers " + html::number(simulated) + " s of operation";
  if (std::isfinite(simulated) && std::isfinite(steps)) text += " in " + html::count(std::llround(steps)) + " time steps";
  if (std::isfinite(simulated)) text += ".";
  return text + (verdict.empty() ? rags_sentence(member(summary, "rags")) : " " + verdict);
}

std::string run_table(const json& summary) {
  Rows rows;
  add_rows(rows, summary,
           {{"case", "Case", ""},
            {"case_sha256", "Case hash (SHA-256)", ""},
            {"version", "Version of Snag", ""},
            {"git", "Revision of the sources", ""},
            {"ranks", "Processes (MPI ranks)", ""},
            {"simulated_s", "Simulated time", "s"},
            {"time_steps", "Time steps of the water", ""}},
           false);
  if (const double wall = real(summary, "wall_s"); std::isfinite(wall)) rows.push_back({"Duration of the run", duration(wall)});
  if (real(member(summary, "mesh"), "cells") == 0) return table_of({}, rows);  // no water
  add_rows(rows, member(summary, "mesh"),
           {{"cells", "Cells of the mesh", ""},
            {"interior_faces", "Internal faces", ""},
            {"facets", real(member(summary, "mesh"), "facets") == 0 ? "" : "Facets of the sliding interface", ""},
            {"min_quality", "Lowest quality of a cell (1 is best)", ""}});
  std::erase_if(rows, [](const auto& row) { return row[0].empty(); });
  return table_of({}, rows);
}

std::string pump_table(const json& summary) {
  const json& pump = member(summary, "pump");
  if (!pump.is_object()) return "";
  Rows rows;
  add_rows(rows, pump,
           {{"flow_m3_s", "Flow rate", "m³/s"},
            {"head_m", "Head", "m"},
            {"head_total_m", "Head of the total pressure", "m"},
            {"torque_Nm", "Torque", "N m"},
            {"shaft_power_W", "Shaft power", "W"},
            {"torque_contacts_Nm", "Torque of the rags' contacts on the shaft", "N m"},
            {"shaft_power_total_W", "Shaft power with that of the contacts", "W"},
            {"efficiency", "Hydraulic efficiency", ""},
            {"revolutions", "Revolutions of the run", ""}});
  const bool is_part = real(pump, "revolutions") < 1;
  return table_of({is_part ? "Mean of the whole run: no revolution is complete" : "Mean of the last complete revolution", "Value"}, rows);
}

std::string balance_tables(const json& summary) {
  const json& balance = member(summary, "balance");
  const double torque = real(balance, "torque_shaft_Nm"), power = real(balance, "power_shaft_W");
  if (!std::isfinite(torque) || !std::isfinite(power)) return "";
  const auto share = [](double part, double whole) { return whole != 0 ? html::number(100 * part / whole) + " %" : std::string("-"); };
  Rows rows;
  const auto add = [&](const char* meaning, const char* key) {
    if (const double value = real(balance, key); std::isfinite(value))
      rows.push_back({meaning, html::number(value) + " W", share(value, power)});
  };
  add("Power of the moving walls on the water", "power_shaft_W");
  add("Power of rags and body force on the water", "power_given_W");
  add("Hydraulic power: total pressure times flow rate, out less in", "power_hydraulic_W");
  add("Stored as kinetic energy of the water", "power_stored_W");
  add("Dissipated by the viscosity of the water", "power_dissipated_viscous_W");
  add("Dissipated by turbulence (eddy viscosity)", "power_dissipated_turbulent_W");
  add("Dissipated between walls and the centres of their cells", "power_dissipated_walls_W");
  add("Numerical dissipation", "power_numerical_W");
  std::string result = table_of({"Power, mean as above", "Value", "Share of the shaft"}, rows);
  Rows errors;
  const double lost = real(balance, "torque_lost_rel"), numerical = real(balance, "power_numerical_W");
  if (std::isfinite(lost))
    errors.push_back(
        {"Numerical loss of angular momentum, in rotor and stator", html::number(100 * lost) + " %",
         "Of the angular momentum that the shaft gives to the water, this share is lost or made in the computation: torque and head "
         "can disagree by as much. It falls with the square of the cell size."});
  if (power != 0)
    errors.push_back({"Numerical dissipation of power", share(numerical, power),
                      "Of the power of the shaft, this share is dissipated by the discretisation and not by a physical cause: it counts as "
                      "a loss of the "
                      "pump, which finer cells and shorter steps reduce."});
  return result + table_of({"Error of the discretisation", "Share of the shaft", "What it means"}, errors);
}

namespace {

/// What friction at a wall with this mean y+ is worth; numbers: docs/theory.md, section 2.2.
std::string y_plus_verdict(const std::string& treatment, double y_plus) {
  if (treatment == "automatic") {
    if (y_plus <= 1) return "Resolved: friction of a pipe was within 2 % of Colebrook's formula.";
    if (y_plus <= 300) return "Good: friction of a pipe was within 4 % of that with y+ 1.";
    return "Too thick: the model was verified up to y+ 300 only; thinner cells are needed.";
  }
  if (treatment != "wall_functions") return "-";
  if (y_plus < 11)
    return "Thin: cells are taken for such at y+ 11.5; friction of a pipe was 2 to 4 % below Colebrook's formula at y+ 3 to 8, and up to "
           "6 % above it at y+ 1 to 5 and Re 1e5 (realizable model: 11 to 13 % below).";
  if (y_plus < 30)
    return "Thinner than wall functions are made for: friction of a pipe was 2 to 4 % below Colebrook's formula (realizable model: 9 to 11 "
           "%).";
  if (y_plus <= 300) return "Good: friction of a pipe was 3 to 4 % below Colebrook's formula (realizable model: 5 to 9 %).";
  return "Thick: friction of a pipe with 10 to 40 cells over its radius was 2 to 3 % below Colebrook's formula at y+ 900 to 3600. Where "
         "the "
         "layer at the wall is thinner than ten cells, as in most pumps, friction is indicative.";
}

}  // namespace

std::string wall_table(const json& summary) {
  const json& walls = member(summary, "walls");
  const json& patches = member(walls, "patches");
  if (!patches.is_array()) return "";
  Rows rows;
  for (const json& patch : patches)
    rows.push_back({text_of(member(patch, "patch")), html::number(real(patch, "y_plus_min")), html::number(real(patch, "y_plus_mean")),
                    html::number(real(patch, "y_plus_max")), y_plus_verdict(word(walls, "treatment"), real(patch, "y_plus_mean"))});
  return table_of({"Wall", "Lowest y+", "Mean y+ over the area", "Highest y+", "What the mean means for friction"}, rows);
}

std::string rag_tables(const json& summary) {
  const json& rags = member(summary, "rags");
  if (!rags.is_array()) return "";
  std::string result;
  for (const auto& rag : rags) {
    Rows rows = {{"Outcome", rag_words(word(rag, "outcome"))}};
    add_rows(rows, rag,
             {{"outcome", "", ""},
              {"id", "", ""},
              {"name", "", ""},
              {"particles", "Particles", ""},
              {"bonds", "Bonds", ""},
              {"broken_bonds", "Broken bonds", ""},
              {"retention_time_s", "Retention time: from wholly inside the casing to wholly out of it", "s"},
              {"time_to_enter_s", "Time to enter: from the first particle at the inlet flange to wholly inside", "s"},
              {"recirculations", "Recirculations past the tongue", ""},
              {"stuck_on_tongue_s", "Time stuck on the tongue", "s"},
              {"stuck_on_impeller_s", "Time stuck on the impeller", "s"},
              {"wall_contact_s", "Time in contact with a wall", "s"},
              {"elongation_ratio_at_start", "Initial elongation ratio", ""},
              {"elongation_ratio", "Elongation ratio at the end: long side over short side", ""},
              {"projected_area_m2", "Projected area at the end", "m²"},
              {"max_wall_overlap_over_radius", "Deepest overlap with a wall, in particle radii", ""},
              {"max_overlap_over_radius", "Deepest overlap between particles, in particle radii", ""},
              {"bond_strain_p99", "Strain that 99 % of the bonds stay below", ""},
              {"max_bond_tension_N", "Largest tension of a bond", "N"}});
    const json& zones = member(rag, "wall_contact_by_zone_s");
    const bool has_tongue = std::isfinite(real(zones, "tongue"));  // a pump
    add_rows(rows, zones,
             {{"impeller", has_tongue ? "Time in contact with the impeller" : "Time in contact with moving walls", "s"},
              {"tongue", "Time in contact with the tongue", "s"},
              {"other", "Time in contact with other walls", "s"}});
    std::erase_if(rows, [](const auto& row) { return row[0].empty(); });
    result += html::table({name_of(rag), "Value"}, rows);
    Rows events;
    if (const json& list = member(rag, "events"); list.is_array())
      for (const auto& event : list) {
        const double angle = real(event, "angle_deg");
        events.push_back({text_of(member(event, "what")), text_of(member(event, "t_s")), std::isfinite(angle) ? html::number(angle) : ""});
      }
    if (!events.empty()) result += html::table({"What happened", "Time [s]", "Angle of the centroid [deg]"}, events);
  }
  return result;
}

std::string check_table(const json& summary) {
  Rows rows;
  for (const CheckedValue& one : checked(summary)) {
    if (!one.value) continue;  // the case has nothing to measure it on
    const char* verdict = one.fails() ? "<span class=\"fail\">FAIL</span>" : "<span class=\"pass\">pass</span>";
    rows.push_back({one.check.meaning, html::number(*one.value), html::number(one.check.limit), verdict});
  }
  return table_of({"Quantity", "Largest value", "Limit", "Check"}, rows);
}

std::string cost_table(const json& summary) {
  const json& performance = member(summary, "performance");
  if (!performance.is_object()) return "";
  struct Part {
    const char* key;
    const char* meaning;
    const char* colour;
  };
  const std::vector<Part> parts = {{"flow_s", "Water", "#0072B2"},
                                   {"dem_s", "Rags", "#D55E00"},
                                   {"coupling_s", "Exchange between them", "#009E73"},
                                   {"output_s", "Output", "#7A5195"}};
  const double wall = real(summary, "wall_s");
  double total = 0;
  for (const auto& part : parts) total += std::max(0.0, real(performance, part.key));
  const double whole = wall > total ? wall : total;
  std::string shares = "<div class=\"shares\">";
  Rows rows;
  const auto add = [&](const std::string& meaning, double seconds, const char* colour) {
    const std::string percent = html::number(100 * seconds / whole) + " %";
    rows.push_back({meaning, html::number(seconds) + " s", percent});
    if (seconds > 0)
      shares += "<div style=\"width:" + std::to_string(100 * seconds / whole) + "%;background:" + colour + "\">" + meaning + "</div>";
  };
  if (whole > 0) {
    for (const auto& part : parts)
      if (const double seconds = real(performance, part.key); std::isfinite(seconds)) add(part.meaning, seconds, part.colour);
    if (wall > total) add("Start and the rest", wall - total, "#8a96a3");
  }
  shares += "</div>\n";
  const double cells = real(performance, "flow_cell_steps_per_s"), particles = real(performance, "dem_particle_steps_per_s"),
               memory = real(performance, "peak_memory_bytes");
  if (std::isfinite(cells)) rows.push_back({"Speed of the water: cells times steps", html::number(cells) + " per second", ""});
  if (std::isfinite(particles)) rows.push_back({"Speed of the rags: particles times steps", html::number(particles) + " per second", ""});
  if (std::isfinite(memory)) rows.push_back({"Largest memory, all processes", html::bytes(memory), ""});
  if (rows.empty()) return "";
  return (whole > 0 ? shares : "") + html::table({"Part of the run", "Value", "Share"}, rows);
}

}  // namespace snag
