#include "simulation/output/step_record.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

const char* const file_name = "step.json";

nlohmann::ordered_json finite(double value) { return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(); }

nlohmann::ordered_json or_null(const std::optional<double>& value) { return value ? finite(*value) : nlohmann::ordered_json(); }

double number_of(const nlohmann::json& value) { return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>(); }

std::optional<double> optional_of(const nlohmann::json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

StepRecord record_of(const nlohmann::json& json) {
  StepRecord record{.step = json.at("step_s"),
                    .steps_per_revolution = json.at("steps_per_revolution"),
                    .accuracy = optional_of(json.at("accuracy")),
                    .rag_accuracy = optional_of(json.at("rag_accuracy")),
                    .is_reached = json.at("accuracy_reached"),
                    .settling_revolutions = json.at("settling_revolutions"),
                    .water = {},
                    .rag = {},
                    .notes = json.at("notes"),
                    .wall = json.at("trial_wall_s")};
  for (const auto& one : json.at("water"))
    record.water.push_back({.steps_per_revolution = one.at("steps_per_revolution"),
                            .revolutions = one.at("revolutions"),
                            .step = one.at("step_s"),
                            .head = one.at("head_m"),
                            .torque = one.at("torque_Nm"),
                            .head_error = number_of(one.at("head_error_rel")),
                            .torque_error = number_of(one.at("torque_error_rel"))});
  for (const auto& one : json.at("rag"))
    record.rag.push_back({.steps_per_revolution = one.at("steps_per_revolution"),
                          .step = one.at("step_s"),
                          .duration = one.at("duration_s"),
                          .path = one.at("path_m"),
                          .impulse = one.at("impulse_N_s"),
                          .path_error = number_of(one.at("path_error_rel")),
                          .impulse_error = number_of(one.at("impulse_error_rel"))});
  return record;
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "none";
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
  return text;
}

/// Columns of equal width, right-justified.
std::string row(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) line += "  " + std::string(cell.size() < 14 ? 14 - cell.size() : 0, ' ') + cell;
  return line;
}

std::string degrees_text(int steps_per_revolution) { return rounded(360.0 / steps_per_revolution); }

std::string table_of_water(const StepRecord& record) {
  std::string text = "\nwater alone, mean of revolution " + std::to_string(record.water.front().revolutions) +
                     " of each trial, with its error by the step:\n" +
                     row({"degrees a step", "step [s]", "head [m]", "error", "torque [N m]", "error"});
  for (const StepRecord::OfWater& one : record.water)
    text += "\n" + row({degrees_text(one.steps_per_revolution), number_text(one.step), number_text(one.head), percent(one.head_error),
                        number_text(one.torque), percent(one.torque_error)});
  return text;
}

std::string table_of_rag(const StepRecord& record) {
  std::string text = "\nrag, " + rounded(1e3 * record.rag.front().duration) + " ms of motion before its first contact:\n" +
                     row({"degrees a step", "step [s]", "path [m]", "error", "impulse [N s]", "error"});
  for (const StepRecord::OfRag& one : record.rag)
    text += "\n" + row({degrees_text(one.steps_per_revolution), number_text(one.step), number_text(one.path), percent(one.path_error),
                        number_text(one.impulse), percent(one.impulse_error)});
  return text;
}

}  // namespace

nlohmann::ordered_json step_json(const StepRecord& record) {
  nlohmann::ordered_json water = nlohmann::ordered_json::array(), rag = nlohmann::ordered_json::array();
  for (const StepRecord::OfWater& one : record.water)
    water.push_back({{"steps_per_revolution", one.steps_per_revolution},
                     {"step_s", one.step},
                     {"revolutions", one.revolutions},
                     {"head_m", one.head},
                     {"head_error_rel", finite(one.head_error)},
                     {"torque_Nm", one.torque},
                     {"torque_error_rel", finite(one.torque_error)}});
  for (const StepRecord::OfRag& one : record.rag)
    rag.push_back({{"steps_per_revolution", one.steps_per_revolution},
                   {"step_s", one.step},
                   {"duration_s", one.duration},
                   {"path_m", one.path},
                   {"path_error_rel", finite(one.path_error)},
                   {"impulse_N_s", one.impulse},
                   {"impulse_error_rel", finite(one.impulse_error)}});
  return {{"step_s", record.step},
          {"steps_per_revolution", record.steps_per_revolution},
          {"degrees_per_step", record.degrees()},
          {"accuracy", or_null(record.accuracy)},
          {"rag_accuracy", or_null(record.rag_accuracy)},
          {"accuracy_reached", record.is_reached},
          {"settling_revolutions", record.settling_revolutions},
          {"water", water},
          {"rag", rag},
          {"notes", record.notes},
          {"trial_wall_s", record.wall}};
}

void write_step_record(const std::filesystem::path& folder, const StepRecord& record) {
  write_atomically(folder / file_name, step_json(record).dump(2) + "\n");
}

std::optional<StepRecord> read_step_record(const std::filesystem::path& folder) {
  const auto text = file_text(folder / file_name);
  if (!text) return {};
  try {
    return record_of(nlohmann::json::parse(*text));
  } catch (const nlohmann::json::exception&) {
    throw Error(ExitCode::io, (folder / file_name).string() +
                                  ": is damaged, it must hold the step that the run found; give [time] step_s of case.resolved.toml");
  }
}

std::string step_in_words(const StepRecord& record) {
  std::string text = "[time] step = \"auto\": " + number_text(record.step) + " s, " + rounded(record.degrees()) + " degrees a step, " +
                     std::to_string(record.steps_per_revolution) + " steps a revolution";
  if (record.accuracy) text += ", for an accuracy of " + percent(*record.accuracy);
  if (record.accuracy && !record.is_reached) text += " that is not reached";
  if (!record.water.empty()) text += table_of_water(record);
  if (!record.rag.empty()) text += table_of_rag(record);
  for (const std::string& note : record.notes) text += "\n" + note;
  if (record.accuracy) text += "\nthe trial took " + duration(record.wall);
  return text;
}

}  // namespace snag
