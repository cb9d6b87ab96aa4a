#include "report/step_section.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "base/progress.hpp"
#include "base/words.hpp"
#include "report/html.hpp"

namespace snag {

namespace {

using nlohmann::json;

std::string percent(const json& share) { return share.is_number() ? html::number(100 * share.get<double>()) + " %" : "none"; }

std::string degrees(const json& trial) { return html::number(360.0 / trial.at("steps_per_revolution").get<int>()); }

std::string table_of_water(const json& trials) {
  std::vector<std::vector<std::string>> rows;
  for (const json& one : trials)
    rows.push_back({degrees(one), html::number(1e3 * one.at("step_s").get<double>()), html::number(one.at("head_m")),
                    percent(one.at("head_error_rel")), html::number(one.at("torque_Nm")), percent(one.at("torque_error_rel"))});
  return "<p>Water alone, means over the last revolution of each trial:</p>\n" +
         html::table({"degrees a step", "step [ms]", "head [m]", "error by the step", "torque [N m]", "error by the step"}, rows);
}

std::string table_of_rag(const json& trials) {
  std::vector<std::vector<std::string>> rows;
  for (const json& one : trials)
    rows.push_back({degrees(one), html::number(1e3 * one.at("step_s").get<double>()), html::number(one.at("path_m")),
                    percent(one.at("path_error_rel")), html::number(one.at("impulse_N_s")), percent(one.at("impulse_error_rel"))});
  return "<p>The rag, " + html::number(1e3 * trials.front().at("duration_s").get<double>()) + " ms after it was put in:</p>\n" +
         html::table({"degrees a step", "step [ms]", "path [m]", "error by the step", "impulse of the water [N s]", "error by the step"},
                     rows);
}

}  // namespace

std::string step_section(const json& summary) {
  if (!summary.is_object() || !summary.contains("auto_step")) return "";
  const json& found = summary["auto_step"];
  std::string text = "<p>The step is " + html::number(1e3 * found.at("step_s").get<double>()) + " ms, " +
                     html::number(found.at("degrees_per_step")) + " degrees of the rotor";
  if (found.at("accuracy").is_null()) return text + ", as the case asks for.</p>\n";
  text += found.at("accuracy_reached").get<bool>() ? ", the largest one that gives head and torque within "
                                                   : ", the smallest one that was tried; head and torque are not within ";
  text += percent(found.at("accuracy"));
  if (found.at("rag_accuracy").is_number())
    text += " and the motion of the rag before its first contact within " + percent(found.at("rag_accuracy"));
  text += ". The trial took " + duration(found.at("trial_wall_s")) + ".</p>\n";
  if (!found.at("water").empty()) text += table_of_water(found.at("water"));
  if (!found.at("rag").empty()) text += table_of_rag(found.at("rag"));
  for (const json& note : found.at("notes")) text += "<p>" + escaped(note.get<std::string>()) + ".</p>\n";
  return text;
}

}  // namespace snag
