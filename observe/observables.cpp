#include "observe/observables.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

namespace snag {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

template <int axis>
double position(const Motion& motion) {
  return motion.position[axis];
}
template <int axis>
double velocity(const Motion& motion) {
  return motion.velocity[axis];
}
double area(const Silhouette& picture) { return picture.area; }
double elongation_ratio(const Silhouette& picture) { return picture.elongation_ratio; }
double orientation(const Silhouette& picture) { return picture.orientation; }
double retention_time(const PassageResult& passage) { return passage.retention_time.value_or(none); }
double time_to_enter(const PassageResult& passage) { return passage.time_to_enter.value_or(none); }
double recirculations(const PassageResult& passage) { return passage.recirculations ? static_cast<double>(*passage.recirculations) : none; }
double stuck(const PassageResult& passage) { return words_of(passage.outcome).is_stuck ? 1 : 0; }
double exited(const PassageResult& passage) { return passage.outcome == Outcome::exited ? 1 : 0; }

std::map<int, std::vector<ObservableRecord>>& groups() {
  static std::map<int, std::vector<ObservableRecord>> all;
  return all;
}

const bool motion_group =
    add_observables(10, {{"x", "m", Measure::position, 0, position<0>, Needs::nothing, "centre of mass", velocity<0>},
                         {"y", "m", Measure::position, 1, position<1>, Needs::nothing, "centre of mass", velocity<1>},
                         {"z", "m", Measure::position, 2, position<2>, Needs::nothing, "centre of mass", velocity<2>},
                         {"vx", "m/s", Measure::velocity, 0, velocity<0>, Needs::nothing, "velocity of the centre of mass"},
                         {"vy", "m/s", Measure::velocity, 1, velocity<1>, Needs::nothing, "velocity of the centre of mass"},
                         {"vz", "m/s", Measure::velocity, 2, velocity<2>, Needs::nothing, "velocity of the centre of mass"}});

const bool picture_group = add_observables(
    20,
    {{"area", "m2", Measure::area, -1, area, Needs::nothing, "area in the picture"},
     {"elongation_ratio", "1", Measure::ratio, -1, elongation_ratio, Needs::nothing, "long over short axis of the ellipse in the picture"},
     {"orientation", "rad", Measure::axis_angle, -1, orientation, Needs::nothing, "direction of the long axis in the picture"}});

const bool passage_group = add_observables(
    30, {{"retention_time", "s", Measure::duration, -1, retention_time, Needs::planes, "from wholly in to wholly out"},
         {"time_to_enter", "s", Measure::duration, -1, time_to_enter, Needs::pump, "from the first particle in to wholly in"},
         {"recirculations", "1", Measure::count, -1, recirculations, Needs::pump, "passes of the tongue back into the volute"},
         {"stuck", "1", Measure::event, -1, stuck, Needs::pump, "1: it is stuck on the tongue or the impeller at the end"},
         {"exited", "1", Measure::event, -1, exited, Needs::nothing, "1: it is wholly out at the end"}});

}  // namespace

double ObservableRecord::period() const { return measure == Measure::axis_angle ? std::numbers::pi : 0; }

bool add_observables(int place, const std::vector<ObservableRecord>& group) {
  if (!groups().emplace(place, group).second) throw std::logic_error("two groups of observables have the place " + std::to_string(place));
  return true;
}

const std::vector<ObservableRecord>& observables() {
  static const std::vector<ObservableRecord> all = [] {
    std::vector<ObservableRecord> records;
    for (const auto& [place, group] : groups()) records.insert(records.end(), group.begin(), group.end());
    return records;
  }();
  return all;
}

const ObservableRecord* find_observable(std::string_view id) {
  const auto& all = observables();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ObservableRecord& one) { return one.id == id; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> observable_ids() {
  std::vector<std::string> ids;
  for (const ObservableRecord& one : observables()) ids.emplace_back(one.id);
  return ids;
}

}  // namespace snag
