#include "simulation/output/summary.hpp"

#include <mpi.h>
#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/version.hpp"
#include "base/words.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

double rate(double amount, double seconds) { return seconds > 0 ? amount / seconds : 0; }

std::string signed_percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.2g %%", 100 * share);
  return text;
}

/// Null where there is no value.
template <class T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

nlohmann::ordered_json components(const Vec3& v) { return {v.x, v.y, v.z}; }

nlohmann::ordered_json events_json(const PassageResult& rag) {
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  for (const auto& event : rag.events)
    events.push_back({{"t_s", event.time}, {"angle_deg", or_null(event.angle)}, {"what", words_of(event.what).key}});
  return events;
}

nlohmann::ordered_json volute_json(const PassageResult& rag) {
  nlohmann::ordered_json bins = nlohmann::ordered_json::array();
  for (int bin = 0; rag.volute && bin < n_volute_bins; ++bin) {
    const double time = rag.volute->time[bin];
    nlohmann::ordered_json radius;
    if (time > 0) radius = rag.volute->radius_time[bin] / time;
    bins.push_back({{"angle_deg", (bin + 0.5) * 360 / n_volute_bins}, {"time_s", time}, {"mean_radius_m", radius}});
  }
  return bins;
}

nlohmann::ordered_json tension_json(const PassageResult& rag) {
  if (!rag.max_tension_time) return {};
  return {{"t_s", *rag.max_tension_time}, {"x_m", components(rag.max_tension_place)}, {"angle_deg", or_null(rag.max_tension_angle)}};
}

/// Of the pump before, while and after a rag passes; null where it is not known.
nlohmann::ordered_json passage_json(const PumpPassage& pump) {
  nlohmann::ordered_json json;
  const auto add = [&](const std::string& name, const std::string& unit, double PumpMeans::*value) {
    for (const auto& [when, means] : {std::pair{"before", &pump.before}, {"passing", &pump.passing}, {"after", &pump.after}})
      json[name + "_" + when + "_" + unit] = *means ? nlohmann::ordered_json((**means).*value) : nlohmann::ordered_json();
    json[name + "_change_rel"] = or_null(pump.change(value));
  };
  add("head", "m", &PumpMeans::head);
  add("shaft_power", "W", &PumpMeans::shaft_power);
  return json;
}

nlohmann::ordered_json free_motion_json(const FreeMotionResult& free) {
  return {{"duration_s", free.duration},
          {"path_m", free.path},
          {"impulse_N_s", components(free.impulse)},
          {"mean_force_N", components(free.mean_force())}};
}

nlohmann::ordered_json coupling_json(const CouplingSummary& coupling) {
  return {{"kernel_width_m", coupling.kernel_width},
          {"kernel_width_over_cell_least", coupling.width_over_cell_least},
          {"kernel_width_over_cell_largest", coupling.width_over_cell_largest},
          {"max_solid_fraction", coupling.max_solid_fraction},
          {"force_share_at_walls", or_null(coupling.force_share_at_walls)},
          {"force_displacement_m", or_null(coupling.force_displacement)},
          {"couple_lost_rel", or_null(coupling.couple_lost)}};
}

nlohmann::ordered_json rag_json(const RagSummary& rag) {
  const PassageResult& verdict = rag.verdict;
  return {{"id", rag.id},
          {"name", rag.name},
          {"particles", rag.particles},
          {"bonds", rag.bonds},
          {"broken_bonds", rag.broken_bonds},
          {"outcome", words_of(verdict.outcome).key},
          {"retention_time_s", or_null(verdict.retention_time)},
          {"time_to_enter_s", or_null(verdict.time_to_enter)},
          {"recirculations", or_null(verdict.recirculations)},
          {"stuck_on_tongue_s", or_null(verdict.stuck_on_tongue)},
          {"stuck_on_impeller_s", or_null(verdict.stuck_on_impeller)},
          {"first_contact_s", or_null(rag.free_motion.first_contact)},
          {"before_contact", free_motion_json(rag.free_motion)},
          {"wall_contact_s", verdict.wall_contact},
          {"wall_contact_by_zone_s",
           {{"impeller", verdict.impeller_contact}, {"tongue", or_null(verdict.tongue_contact)}, {"other", verdict.other_contact}}},
          {"pump", passage_json(rag.pump)},
          {"elongation_ratio_at_start", rag.elongation_ratio_at_start},
          {"elongation_ratio", rag.elongation_ratio},
          {"projected_area_m2", rag.projected_area},
          {"max_wall_overlap_over_radius", rag.max_wall_overlap_over_radius},
          {"max_overlap_over_radius", rag.max_overlap_over_radius},
          {"bond_strain_p99", rag.bond_strain_p99},
          {"max_bond_tension_N", verdict.max_tension},
          {"max_bond_tension_at", tension_json(verdict)},
          {"volute", volute_json(verdict)},
          {"events", events_json(verdict)}};
}

nlohmann::ordered_json pump_json(const PumpSummary& pump) {
  return {{"flow_m3_s", pump.flow},
          {"head_m", pump.head},
          {"head_total_m", pump.head_total},
          {"torque_Nm", pump.torque},
          {"shaft_power_W", pump.shaft_power},
          {"efficiency", pump.efficiency},
          {"torque_contacts_Nm", pump.torque_contacts},
          {"shaft_power_total_W", pump.shaft_power_total},
          {"revolutions", pump.revolutions}};
}

nlohmann::ordered_json balance_json(const BalanceSummary& balance) {
  return {{"torque_shaft_Nm", balance.shaft_torque},
          {"torque_lost_rotor_Nm", balance.torque_lost_rotor},
          {"torque_lost_stator_Nm", balance.torque_lost_stator},
          {"torque_lost_rel", or_null(balance.torque_lost_rel())},
          {"torque_residual_rel", or_null(balance.torque_residual_rel())},
          {"power_shaft_W", balance.shaft_power},
          {"power_given_W", balance.given_power},
          {"power_hydraulic_W", balance.hydraulic_power},
          {"power_stored_W", balance.stored_power},
          {"power_dissipated_viscous_W", balance.dissipation_viscous},
          {"power_dissipated_turbulent_W", balance.dissipation_turbulent},
          {"power_dissipated_walls_W", balance.dissipation_walls},
          {"power_numerical_W", balance.numerical_power},
          {"power_numerical_rel", or_null(balance.numerical_power_rel())},
          {"power_residual_rel", or_null(balance.power_residual_rel())}};
}

nlohmann::ordered_json water_json(const WaterSummary& water) {
  return {{"speed_scale_m_s", water.speed_scale},
          {"max_speed_over_scale", water.max_speed_over_scale},
          {"unsolved_steps", water.unsolved_steps},
          {"molecular_over_eddy_viscosity", or_null(water.molecular_over_eddy_viscosity)}};
}

nlohmann::ordered_json walls_json(const WallsSummary& walls) {
  nlohmann::ordered_json patches = nlohmann::ordered_json::array();
  for (const auto& [patch, y_plus] : walls.patches)
    patches.push_back({{"patch", patch}, {"y_plus_min", y_plus.lowest}, {"y_plus_mean", y_plus.mean}, {"y_plus_max", y_plus.highest}});
  return {{"treatment", name_of(walls.treatment)}, {"patches", patches}};
}

/// A summary in which nothing is missing.
Summary full_summary() {
  Summary full;
  StepRecord& step = full.auto_step.emplace();
  step.steps_per_revolution = 1;
  step.water.emplace_back(), step.rag.emplace_back(), step.notes.emplace_back();
  full.pump.emplace();
  full.balance.emplace();
  full.water.emplace();
  full.coupling.emplace();
  full.walls.emplace().patches.emplace_back();
  full.error = "none";
  PassageResult& rag = full.rags.emplace_back().verdict;
  rag.volute.emplace(), rag.max_tension_time = 0;
  rag.events.push_back({});
  return full;
}

}  // namespace

std::string name_of(WallTreatment treatment) {
  switch (treatment) {
    case WallTreatment::wall_functions:
      return "wall_functions";
    case WallTreatment::automatic:
      return "automatic";
    default:
      return "none";
  }
}

bool is_of_ended_run(const std::filesystem::path& file, const std::string& case_sha256, std::int64_t time_steps) {
  const auto summary = nlohmann::json::parse(file_text(file).value_or(""), nullptr, false);
  const auto is = [&](const char* key, const nlohmann::json& value) { return summary.contains(key) && summary[key] == value; };
  return summary.is_object() && is("case_sha256", case_sha256) && is("exit", 0) && is("time_steps", time_steps);
}

std::optional<PassageResult> first_passage(const std::filesystem::path& summary_file) {
  const auto summary = nlohmann::json::parse(file_text(summary_file).value_or(""), nullptr, false);
  if (!summary.is_object() || !summary.contains("rags") || summary["rags"].empty()) return {};
  const auto& rag = summary["rags"].front();
  const auto number = [&](const char* key) {
    const auto& value = rag.contains(key) ? rag[key] : nlohmann::json();
    return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
  };
  PassageResult passage;
  passage.outcome = outcome_named(rag.value("outcome", std::string())).value_or(Outcome::in_domain);
  passage.retention_time = number("retention_time_s"), passage.time_to_enter = number("time_to_enter_s");
  if (const auto n = number("recirculations")) passage.recirculations = std::llround(*n);
  return passage;
}

nlohmann::ordered_json summary_json(const Summary& s) {
  nlohmann::ordered_json rags = nlohmann::ordered_json::array();
  for (const RagSummary& rag : s.rags) rags.push_back(rag_json(rag));
  const auto& p = s.performance;
  const auto& kept = s.conservation;
  nlohmann::ordered_json json = {{"version", version_number},
                                 {"git", version_git},
                                 {"case", s.case_name},
                                 {"case_sha256", s.case_sha256},
                                 {"ranks", s.ranks},
                                 {"wall_s", s.wall},
                                 {"exit", s.exit},
                                 {"simulated_s", s.simulated},
                                 {"time_steps", s.time_steps},
                                 {"mesh",
                                  {{"cells", s.mesh.cells},
                                   {"interior_faces", s.mesh.interior_faces},
                                   {"facets", s.mesh.facets},
                                   {"min_quality", s.mesh.min_quality}}},
                                 {"performance",
                                  {{"flow_cell_steps_per_s", rate(p.cell_steps, p.flow)},
                                   {"dem_particle_steps_per_s", rate(p.particle_steps, p.dem)},
                                   {"flow_s", p.flow},
                                   {"dem_s", p.dem},
                                   {"coupling_s", p.coupling},
                                   {"output_s", p.output},
                                   {"peak_memory_bytes", p.peak_memory}}},
                                 {"auto_step", s.auto_step ? step_json(*s.auto_step) : nlohmann::ordered_json()},
                                 {"pump", s.pump ? pump_json(*s.pump) : nlohmann::ordered_json()},
                                 {"balance", s.balance ? balance_json(*s.balance) : nlohmann::ordered_json()},
                                 {"rags", rags},
                                 {"water", s.water ? water_json(*s.water) : nlohmann::ordered_json()},
                                 {"coupling", s.coupling ? coupling_json(*s.coupling) : nlohmann::ordered_json()},
                                 {"walls", s.walls ? walls_json(*s.walls) : nlohmann::ordered_json()},
                                 {"conservation",
                                  {{"mass_imbalance_rel", or_null(kept.mass_imbalance)},
                                   {"momentum_exchange_rel", or_null(kept.momentum_exchange)},
                                   {"interface_closure_rel", or_null(kept.interface_closure)},
                                   {"particles_lost", or_null(kept.particles_lost)},
                                   {"bonds_lost", or_null(kept.bonds_lost)},
                                   {"particles_beyond_walls", or_null(kept.particles_beyond_walls)}}}};
  if (!s.auto_step) json.erase("auto_step");
  if (!s.pump) json.erase("pump");
  if (!s.balance) json.erase("balance");
  if (!s.water) json.erase("water");
  if (!s.coupling) json.erase("coupling");
  if (!s.walls) json.erase("walls");
  if (!s.error.empty()) json["error"] = s.error;
  return json;
}

void write_summary(const std::filesystem::path& file, const Summary& summary) {
  write_atomically(file, summary_json(summary).dump(2) + "\n");
}

std::vector<std::string> summary_keys() {
  std::vector<std::string> keys;
  const nlohmann::ordered_json flat = summary_json(full_summary()).flatten();
  for (const auto& [place, value] : flat.items()) {
    const std::vector<std::string> words = split(place.substr(1), '/');
    // Of a list its first entry stands for all.
    if (std::any_of(words.begin(), words.end(), [](const std::string& word) { return std::isdigit(word[0]) && word != "0"; })) continue;
    std::string key;
    for (const std::string& word : words) key += (key.empty() ? "" : ".") + word;
    keys.push_back(key);
  }
  return keys;
}

std::string results_in_words(const Summary& summary) {
  const auto seconds = [](const std::optional<double>& time) { return time ? number_text(*time) + " s" : std::string("-"); };
  std::string text;
  for (const RagSummary& rag : summary.rags) {
    const PassageResult& verdict = rag.verdict;
    text += (text.empty() ? "" : "\n") + rag.name + ": " + words_of(verdict.outcome).key;
    if (verdict.recirculations)
      text += ", retention time " + seconds(verdict.retention_time) + ", time to enter " + seconds(verdict.time_to_enter) +
              ", recirculations " + std::to_string(*verdict.recirculations);
    text += ", wall contact " + seconds(verdict.wall_contact);
    if (verdict.recirculations)
      text += " (impeller " + seconds(verdict.impeller_contact) + ", tongue " + seconds(verdict.tongue_contact) + ")";
    if (const auto head = rag.pump.change(&PumpMeans::head), power = rag.pump.change(&PumpMeans::shaft_power); head && power)
      text += ", head " + signed_percent(*head) + " and shaft power " + signed_percent(*power) + " while it passed";
  }
  if (summary.pump)
    text +=
        (text.empty() ? "" : "\n") + ("pump: head " + number_text(summary.pump->head) + " m at " + number_text(1e3 * summary.pump->flow) +
                                      " L/s" + (summary.pump->revolutions < 1 ? ", a mean over the start: no revolution is complete" : ""));
  return text;
}

std::int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return sum(MPI_COMM_WORLD, static_cast<std::int64_t>(usage.ru_maxrss) * 1024);
}

}  // namespace snag
