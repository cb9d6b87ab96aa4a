#include "simulation/setup/checks.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/words.hpp"
#include "solver/divergence.hpp"

namespace snag {

namespace {

using nlohmann::json;

const std::vector<Check>& all_checks() {
  constexpr auto water = ExitCode::diverged, rags = ExitCode::invariant;
  // Limits: round-off of sums over the cells for what is exact; a hundred times the default tolerance of pressure for mass; half a radius
  // for contacts, which beyond it are no longer those of a sphere with a wall.
  static const std::vector<Check> checks = {
      {"water.max_speed_over_scale", "Fastest water, over the speed of the case", DivergenceBounds::speed, water,
       "the water diverges: see the error for the cell, and what to do there"},
      {"water.unsolved_steps",
       "Longest sequence of time steps with an unconverged equation (of k and epsilon: the last sequence, with steps in which one fell to "
       "nothing)",
       DivergenceBounds::unsolved_steps, water, "use a shorter [time] step, or look for thin cells (snag mesh --info)"},
      {"water.molecular_over_eddy_viscosity",
       "Viscosity of the water, over the largest eddy viscosity away from walls (at a Reynolds number above 4000)", 1, water,
       "there is no turbulence at the end, it died out or had no time to grow: use a shorter [time] step, a longer run or a larger "
       "[turbulence] initial_k; give model = \"laminar\" where that is meant"},
      {"conservation.mass_imbalance_rel",
       "Mass imbalance (root sum of squares over the cells) over the flow rate through the domain; that flow rate counts at least 1 % of "
       "the speed of the case times the area of its openings (a closed domain: of a cut)",
       1e-4, water, "give [flow] pressure_tolerance a smaller value"},
      {"conservation.momentum_exchange_rel", "Momentum lost between water and rags, over what was exchanged", 1e-10, rags,
       "report this as an error of the program"},
      {"conservation.interface_closure_rel", "Gap of the sliding interface, over its area", 1e-12, rags,
       "report this as an error of the program"},
      {"conservation.particles_lost", "Particles lost", 0, rags, "report this as an error of the program"},
      {"conservation.bonds_lost", "Bonds lost (other than by breaking)", 0, rags, "report this as an error of the program"},
      {"conservation.particles_beyond_walls", "Particles beyond a wall", 0, rags,
       "raise [contact] wall_stiffness_factor, or give [contact] impact_speed the speed of the fastest wall"},
      {"rags.*.max_wall_overlap_over_radius", "Deepest overlap of a particle with a wall, in its radii", 0.5, rags,
       "raise [contact] wall_stiffness_factor, or give [contact] impact_speed the speed of the fastest wall"},
  };
  return checks;
}

/// Number at a path; a null or absent one is not measured, anything else that is no number fails as NaN.
std::optional<double> number_at(const json& table, const std::string& path) {
  const auto dot = path.find('.');
  const std::string key = path.substr(0, dot);
  if (!table.is_object() || !table.contains(key)) return {};
  const json& value = table[key];
  if (dot != std::string::npos) return number_at(value, path.substr(dot + 1));
  if (value.is_null()) return {};
  return value.is_number() ? value.get<double>() : NAN;
}

std::optional<double> largest_of(const json& list, const std::string& key) {
  std::optional<double> largest;
  if (!list.is_array()) return largest;
  for (const json& one : list)
    if (const auto value = number_at(one, key); value && (!largest || !(*value <= *largest))) largest = value;
  return largest;
}

}  // namespace

std::vector<CheckedValue> checked(const json& summary) {
  std::vector<CheckedValue> results;
  const std::string of_rags = "rags.*.";
  for (const Check& check : all_checks()) {
    CheckedValue result{check, {}};
    if (!check.key.starts_with(of_rags))
      result.value = number_at(summary, check.key);
    else if (summary.is_object() && summary.contains("rags"))
      result.value = largest_of(summary["rags"], check.key.substr(of_rags.size()));
    results.push_back(result);
  }
  return results;
}

std::string failure_in_words(const CheckedValue& failed) {
  return failed.check.meaning + ": " + number_text(failed.value.value_or(NAN)) + ", must not exceed " + number_text(failed.check.limit) +
         "; " + failed.check.remedy;
}

}  // namespace snag
