#pragma once
// What can be measured of the pieces of a run: one record for each observable. A run in memory, a run in a folder, the diagnosis and its
// blind benchmark read the records. A new observable is a record (and a row of the tutorial on the diagnosis).
#include <any>
#include <functional>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include "base/vec3.hpp"
#include "observe/passage_result.hpp"
#include "observe/silhouette.hpp"

namespace snag {

/// Of the centre of mass; m, m/s.
struct Motion {
  Vec3 position, velocity;
};

/// How an observable is read from its source, which is a struct: the motion or the picture of the pieces, the passage of the first one.
/// casework/sources/ says how a run gives each source.
class Reading {
 public:
  Reading() = default;
  template <class Source>
  Reading(double (*read)(const Source&))
      : source_(typeid(Source)), read_([read](const std::any& source) { return read(std::any_cast<const Source&>(source)); }) {}

  template <class Source>
  bool is_of() const {
    return source_ == typeid(Source);
  }
  std::type_index source() const { return source_; }
  bool is_there() const { return read_ != nullptr; }
  /// `source`: holds the struct.
  double operator()(const std::any& source) const { return read_(source); }

 private:
  std::type_index source_ = typeid(void);
  std::function<double(const std::any&)> read_;
};

/// What kind of number it is: how a camera's scale changes it, and how it is averaged. The last three are of the whole run, the others of a
/// time.
enum class Measure { position, velocity, area, ratio, axis_angle, force, duration, count, event };

/// What of the case defines it: nothing more; planes through which a piece comes in and goes out; the flanges and the tongue of a pump; a
/// hold.
enum class Needs { nothing, planes, pump, hold };

struct ObservableRecord {
  const char* id;
  const char* unit;  // SI, as in the monitors of a run
  Measure measure;
  int axis;  // of a position or velocity: 0, 1, 2 along x, y, z; -1: none
  Reading read;
  Needs needs;
  const char* meaning;
  Reading rate{};  // its rate of change, from the same source: between two steps it is then cubic in time, else linear

  bool is_of_whole_run() const { return measure == Measure::duration || measure == Measure::count || measure == Measure::event; }
  bool is_position() const { return measure == Measure::position; }
  /// Power of a camera's scale in it: 1 of a length or a velocity, 2 of an area.
  int scale_power() const { return axis >= 0 ? 1 : measure == Measure::area ? 2 : 0; }
  /// Of an angle, rad: an axis has no head; 0: it is no angle.
  double period() const;
};

/// Registers observables; `place`: of the group among the others, no two have the same. Returns true, so that a constant can hold the
/// registration. To be called before main() only.
bool add_observables(int place, const std::vector<ObservableRecord>& group);

/// In the order of their places: that of the tutorial.
const std::vector<ObservableRecord>& observables();
/// Null: there is none of that name.
const ObservableRecord* find_observable(std::string_view id);
std::vector<std::string> observable_ids();

}  // namespace snag
