#pragma once
// What can be measured of the pieces of a run: one row of the table for each observable. A run in memory, a run in a folder, the diagnosis,
// its blind benchmark and the manual read the table; a new observable is a new row (and a row of the tutorial on the diagnosis).
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/vec3.hpp"
#include "observe/passage_result.hpp"
#include "observe/silhouette.hpp"

namespace snag {

/// Of the centre of mass; m, m/s.
struct Motion {
  Vec3 position, velocity;
};

/// Where an observable comes from, and how: the motion or the picture at a time, or the passage over the whole run.
using Reading = std::variant<double (*)(const Motion&), double (*)(const Silhouette&), double (*)(const PassageResult&)>;

/// What kind of number it is: how a camera's scale changes it, and how it is averaged.
enum class Measure { position, velocity, area, ratio, axis_angle, duration, count, event };

/// What of the case defines it: nothing more; planes through which a piece comes in and goes out; the flanges and the tongue of a pump.
enum class Needs { nothing, planes, pump };

struct ObservableRecord {
  const char* id;
  const char* unit;  // SI, as in the monitors of a run
  Measure measure;
  int axis;  // of a position or velocity: 0, 1, 2 along x, y, z; -1: none
  Reading read;
  Needs needs;
  const char* meaning;

  bool is_of_picture() const { return std::holds_alternative<double (*)(const Silhouette&)>(read); }
  bool is_of_whole_run() const { return std::holds_alternative<double (*)(const PassageResult&)>(read); }
  bool is_position() const { return measure == Measure::position; }
  /// Power of a camera's scale in it: 1 of a length or a velocity, 2 of an area.
  int scale_power() const { return axis >= 0 ? 1 : measure == Measure::area ? 2 : 0; }
  /// Of an angle, rad: an axis has no head; 0: it is no angle.
  double period() const;
};

/// In the order of the tutorial.
std::span<const ObservableRecord> observables();
/// Null: there is none of that name.
const ObservableRecord* find_observable(std::string_view id);
std::vector<std::string> observable_ids();

}  // namespace snag
