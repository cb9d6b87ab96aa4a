#include "report/plateau_section.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/words.hpp"
#include "report/html.hpp"

namespace snag {

namespace {

using nlohmann::ordered_json;

std::string percent(double share) {
  if (!std::isfinite(share)) return "more than the mean itself (which is 0)";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

std::string with_unit(double value, const KeyWords& x) { return number_text(value) + (x.unit.empty() ? "" : " " + x.unit); }

std::string range(const PlateauWindow& window, const KeyWords& x) { return number_text(window.from) + " to " + with_unit(window.to, x); }

double recommended(const PlateauQuestion& question, const PlateauWindow& window) {
  const std::string& which = question.settings.recommend;
  return which == "largest" ? window.to : which == "smallest" ? window.from : window.middle;
}

ordered_json window_json(const PlateauQuestion& question, const std::optional<PlateauWindow>& window) {
  if (!window) return {};
  return {{"within_tolerance", window->within_tolerance},
          {"from", window->from},
          {"to", window->to},
          {"n", window->n},
          {"deviation", std::isfinite(window->deviation) ? ordered_json(window->deviation) : ordered_json()},
          {"worst_result", question.settings.results[window->worst]},
          {"worst_group", window->worst_group}};
}

}  // namespace

std::string plateau_in_words(const PlateauQuestion& question, const Plateau& plateau) {
  const auto& [settings, x, results] = question;
  if (!plateau.window)
    return "No plateau: fewer than " + std::to_string(settings.n_least) + " neighbouring values of " + settings.x +
           " have all results in all runs.";
  const PlateauWindow& window = *plateau.window;
  if (window.within_tolerance)
    return "Plateau: from " + range(window, x) + " no result deviates from its mean by more than " + percent(window.deviation) + ". Use " +
           settings.x + " " + with_unit(recommended(question, window), x) + ".";
  return "No plateau, and no recommendation: no " + std::to_string(settings.n_least) + " neighbouring values of " + settings.x +
         " agree within " + percent(settings.tolerance) + ". Nearest to it: " + range(window, x) + ", where \"" + results[window.worst] +
         "\" deviates from its mean by " + percent(window.deviation) + (window.worst_group.empty() ? "" : " (" + window.worst_group + ")") +
         ".";
}

std::string plateau_section(const PlateauQuestion& question, const Plateau& plateau) {
  std::string text = "<p>" + escaped(plateau_in_words(question, plateau)) + "</p>\n";
  if (plateau.by_group.size() < 2) return text;
  std::vector<std::vector<std::string>> cells;
  for (const auto& [group, window] : plateau.by_group) {
    const bool is = window && window->within_tolerance;
    cells.push_back({escaped(group), is ? escaped(range(*window, question.x)) : "none", window ? escaped(percent(window->deviation)) : "",
                     window ? escaped(question.results[window->worst]) : ""});
  }
  return text + "<p>Each group of runs by itself:</p>\n" +
         html::table({"Group", "Plateau", "Largest deviation in it, or where it is least", "Of"}, cells);
}

ordered_json plateau_json(const PlateauQuestion& question, const Plateau& plateau) {
  const bool found = plateau.window && plateau.window->within_tolerance;
  ordered_json groups = ordered_json::array();
  for (const auto& [group, window] : plateau.by_group) groups.push_back({{"group", group}, {"window", window_json(question, window)}});
  return {{"x", question.settings.x},
          {"unit", question.x.unit},
          {"tolerance", question.settings.tolerance},
          {"found", found},
          {"recommended", found ? ordered_json(recommended(question, *plateau.window)) : ordered_json()},
          {"window", window_json(question, plateau.window)},
          {"groups", groups},
          {"words", plateau_in_words(question, plateau)}};
}

}  // namespace snag
