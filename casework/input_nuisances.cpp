#include "casework/input_nuisances.hpp"

#include <map>
#include <numbers>

#include "base/words.hpp"

namespace snag {

std::vector<Nuisance> input_nuisances(const std::vector<const PointCase*>& bases,
                                      const std::vector<std::vector<std::pair<std::string, double>>>& input_u) {
  std::map<std::string, std::vector<int>> shared;  // name, value and uncertainty -> points
  std::map<std::string, std::pair<std::string, double>> record;
  for (std::size_t p = 0; p < bases.size(); ++p)
    for (const auto& [key, u] : input_u[p]) {
      if (u <= 0) continue;
      std::string same = key + "|" + number_text(u) + "|" + bases[p]->value_of(key);
      const bool set_point =
          key.starts_with("flow.") && key.find("viscosity") == std::string::npos && key.find("density") == std::string::npos;
      if (set_point || key == drag_law_uncertainty_per_point) same += "|" + std::to_string(p);
      shared[same].push_back(static_cast<int>(p));
      record[same] = {key, u};
    }
  std::vector<Nuisance> nuisances;
  for (const auto& [same, points] : shared) {
    const auto& [key, u] = record[same];
    // The same thing again is not quite the same: a fluid has the temperature of its day, one particle of a kind is not the other. Half of
    // the variance is each point's own, which costs no runs: both deviations move the same number by the same step.
    if (points.size() > 1 && !key.starts_with(drag_law_uncertainty)) {
      const double half = u / std::numbers::sqrt2;
      nuisances.push_back({key, half, points});
      for (const int p : points) nuisances.push_back({key, half, {p}});
      continue;
    }
    nuisances.push_back({key, u, points});
    // A law that is off by u is off by another u where Re is e times ten: its error is smooth over a decade.
    if (key == drag_law_uncertainty) nuisances.push_back({key + ".slope", u / std::numbers::ln10, points});
  }
  return nuisances;
}

}  // namespace snag
