#include "diagnosis/data/alternative.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/words.hpp"
#include "diagnosis/data/own_candidate.hpp"

namespace snag {

namespace {

Section alternative_section(Alternative& one) {
  Parameter effect = setting("effect", &one.effect, "Name of the effect that this table stands for: one of the library, or a new one.");
  effect.required = true;
  return {
      "alternative",
      "A change of the case that stands for an effect: a candidate that is there or not, and of which nothing is fitted. It replaces the "
      "candidate of the library that has its name.",
      {effect, setting("meaning", &one.meaning, "What it is, in words."),
       setting("set", &one.set, "Values of the case, as for --set, at every point.")},
      true};
}

struct AtTable {
  std::string point;
  std::vector<std::string> values;

  Section section() {
    return {"alternative.at",
            "Values of an alternative that differ between operating points.",
            {setting("point", &point, "Name of the operating point."), setting("set", &values, "Values of its case, as for --set.")},
            true};
  }
};

}  // namespace

std::vector<Section> alternative_sections() {
  static Alternative alternative;
  static AtTable at;
  return {alternative_section(alternative), at.section()};
}

std::vector<Alternative> read_alternatives(const Table& root, const std::vector<std::string>& points) {
  std::vector<Alternative> all;
  for (const Table& table : root.tables("alternative")) {
    Alternative one;
    table.read(alternative_section(one).parameters);
    for (const Table& at : table.tables("at")) {
      AtTable keys;
      at.read(keys.section().parameters);
      const std::string& point = keys.point;
      if (std::find(points.begin(), points.end(), point) == points.end())
        throw Error(ExitCode::usage, at.where() + " point \"" + point + "\" is not the name of a [[point]]; there are " + joined(points));
      one.at[point] = keys.values;
    }
    check_name_of_hypothesis(one.effect, table.where());
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
    auto found = std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == alternative.effect; });
    if (found == effects.end()) found = effects.insert(found, Effect());
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
