#include "simulation/step/step_request.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/parameter_text.hpp"
#include "base/words.hpp"
#include "solver/fields/rotating_zone.hpp"

namespace snag {

namespace {

constexpr double default_accuracy = 0.005;
constexpr double same = 1e-6;  // of a step

/// Of an override "time.step_ms=0.4": it names the key, with or without a unit.
bool names(const std::string& override_text, const std::string& key) {
  const std::string name = override_text.substr(0, override_text.find('='));
  const std::string start = "time." + key;
  if (!name.starts_with(start)) return false;
  return CaseFile::parse("[time]\n" + name.substr(5) + " = 1\n").root().table("time").has(key);
}

}  // namespace

int StepRequest::steps_of_degrees() const {
  return time.degrees_per_step ? static_cast<int>(std::ceil(360 / *time.degrees_per_step - same)) : 0;
}

double StepRequest::accuracy() const { return time.step_accuracy.value_or(default_accuracy); }

double StepRequest::end_at(double step) const {
  const double n = std::ceil(time.end / step - same);
  return std::abs(time.end / step - n) <= same ? time.end : n * step;
}

void StepRequest::check() const {
  if (time.degrees_per_step && time.step_accuracy)
    throw Error(ExitCode::usage, where + " degrees_per_step = " + number_text(*time.degrees_per_step) + " and step_accuracy = " +
                                     number_text(*time.step_accuracy) + " are two rules for one step; keep one of them");
  if (time.degrees_per_step && period == 0)
    throw Error(ExitCode::usage,
                where + " degrees_per_step = " + number_text(*time.degrees_per_step) +
                    " needs a rotor that turns, [rotating_zone] with a rotation_speed, which the case lacks; give step_ms");
  if (!is_auto()) {
    if (time.degrees_per_step && std::abs(time.step / step(steps_of_degrees()) - 1) > same)
      throw Error(ExitCode::usage, where + " step_s = " + number_text(time.step) +
                                       " and degrees_per_step = " + number_text(*time.degrees_per_step) + ", which is a step of " +
                                       number_text(step(steps_of_degrees())) +
                                       " s, contradict each other; remove one of them, or give step = \"auto\"");
    return;
  }
  if (time.degrees_per_step) return;
  const std::string asked = where + " step = \"auto\" with an accuracy of " + number_text(accuracy());
  if (period == 0 || !slides)
    throw Error(ExitCode::usage, asked +
                                     " compares the head and the torque of a pump over whole revolutions, and needs [rotating_zone] with "
                                     "motion = \"sliding\" and a rotation_speed, which the case lacks; give " +
                                     (period == 0 ? "step_ms: `snag check` shows its Courant number" : "degrees_per_step or step_ms"));
  if (!has_pump)
    throw Error(ExitCode::usage, asked +
                                     " compares the head and the torque of a pump, and needs [pump], which the case lacks; add it, or "
                                     "give degrees_per_step or step_ms");
}

StepRequest read_step_request(const CaseFile& file) {
  StepRequest request;
  const Table root = file.root(), time = root.table("time");
  time.read(request.time.section().parameters);
  request.where = time.where();
  request.has_pump = root.has("pump");
  if (root.has("rotating_zone")) {
    RotatingZoneSettings zone;
    root.table("rotating_zone").read(zone.section().parameters);
    request.slides = zone.motion == RotatingZoneSettings::Motion::sliding;
    if (zone.speed != 0) request.period = 2 * std::numbers::pi / std::abs(zone.speed);
  }
  return request;
}

std::vector<std::string> with_step(const StepRequest& request, const std::vector<std::string>& overrides, double step) {
  const double end = request.end_at(step);
  const bool is_whole = end == request.time.end;
  std::vector<std::string> all;
  for (const std::string& text : overrides)
    if (!names(text, "step") && (is_whole || !names(text, "end"))) all.push_back(text);
  all.push_back("time.step_s=" + toml_text(step));
  if (!is_whole) all.push_back("time.end_s=" + toml_text(end));
  return all;
}

}  // namespace snag
