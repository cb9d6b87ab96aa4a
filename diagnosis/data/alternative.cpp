#include "diagnosis/data/alternative.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

std::vector<Alternative> read_alternatives(const Table& root, const std::vector<std::string>& points) {
  std::vector<Alternative> all;
  for (const Table& table : root.tables("alternative")) {
    Alternative one;
    Parameter effect = setting("effect", &one.effect, "Candidate that this stands for.");
    effect.required = true;
    table.read({effect, setting("meaning", &one.meaning, "What it is, in words."),
                setting("set", &one.set, "Values of the case, as for --set, at every point.")});
    for (const Table& at : table.tables("at")) {
      std::string point;
      std::vector<std::string> values;
      at.read({setting("point", &point, "Operating point."), setting("set", &values, "Values of its case, as for --set.")});
      if (std::find(points.begin(), points.end(), point) == points.end())
        throw Error(ExitCode::usage, at.where() + " point \"" + point + "\" is no [[point]]; there are " + joined(points));
      one.at[point] = values;
    }
    if (one.set.empty() && one.at.empty())
      throw Error(ExitCode::usage, table.where() + " " + one.effect +
                                       " changes nothing; give set = [\"section.key=value\"], or "
                                       "[[alternative.at]] with point and set");
    if (std::any_of(all.begin(), all.end(), [&](const Alternative& other) { return other.effect == one.effect; }))
      throw Error(ExitCode::usage, table.where() + ": a second alternative for " + one.effect + "; keep one of them");
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<std::string> overrides_at(const Alternative& alternative, const std::string& point) {
  std::vector<std::string> all = alternative.set;
  if (const auto own = alternative.at.find(point); own != alternative.at.end())
    all.insert(all.end(), own->second.begin(), own->second.end());
  return all;
}

void set_alternatives(std::vector<Effect>& effects, const std::vector<Alternative>& alternatives) {
  for (const Alternative& alternative : alternatives) {
    const auto found = std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == alternative.effect; });
    if (found == effects.end()) {
      std::vector<std::string> known;
      for (const Effect& effect : effects) known.push_back(effect.name);
      throw Error(ExitCode::usage, "[[alternative]] effect \"" + alternative.effect + "\" is no candidate; there are " + joined(known));
    }
    // A range so narrow that linear models take it as it is, wide enough for their integrals.
    constexpr double width = 1e-4;
    *found = {.name = alternative.effect,
              .parameter = alternative.meaning,
              .mean = 1,
              .sd = 1,
              .minimum = 1 - width,
              .maximum = 1 + width,
              .fixed = true};
  }
}

}  // namespace snag
