#include <algorithm>

#include "base/error.hpp"
#include "base/words.hpp"
#include "diagnosis/attribution/attribution.hpp"

namespace snag {

std::vector<int> live_candidates(const Responses& model, std::map<std::string, std::string>& blind) {
  const auto& effects = model.effects();
  const auto& wanted = model.experiment().candidates;
  std::vector<std::string> known;
  for (const Effect& effect : effects) known.push_back(effect.name);
  for (const std::string& name : wanted) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearest_name(name, known);
    throw Error(ExitCode::usage, "[model] candidates: unknown effect \"" + name + "\"" +
                                     (near.empty() ? "" : "; did you mean \"" + near + "\"?") + "; known are " + joined(known));
  }
  std::vector<int> live;
  for (int k = 0; k < static_cast<int>(effects.size()); ++k) {
    if (effects[k].is_local) continue;  // found on the way
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), effects[k].name) == wanted.end()) continue;
    if (effects[k].blind.empty())
      live.push_back(k);
    else
      blind[effects[k].name] = effects[k].blind;
  }
  std::sort(live.begin(), live.end(), [&](int a, int b) { return effects[a].name < effects[b].name; });
  return live;
}

}  // namespace snag
