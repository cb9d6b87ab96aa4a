#pragma once
// What a passage comes to: outcome, times, contacts and events of one rag. observe/passage/passage_tracker.hpp defines and finds them.
#include <cstdint>
#include <optional>
#include <vector>

#include "base/vec3.hpp"
#include "observe/outcome.hpp"
#include "observe/volute_histogram.hpp"

namespace snag {

/// Result of the passage of one rag at the end of a run. A value is absent if its event did not happen or the case has no pump.
struct PassageResult {
  Outcome outcome = Outcome::in_domain;
  std::optional<double> entered, exited;                // s
  std::optional<double> retention_time, time_to_enter;  // s: wholly in the casing to exited; entered to wholly in
  std::optional<std::int64_t> recirculations;
  std::optional<double> stuck_on_tongue, stuck_on_impeller;          // s, of all episodes of more than 1 s
  double wall_contact = 0, impeller_contact = 0, other_contact = 0;  // s
  std::optional<double> tongue_contact;                              // s
  std::optional<VoluteStay> volute;  // of the centroid from wholly in the casing until it has passed the tongue outwards
  double max_tension = 0;
  std::optional<double> max_tension_time, max_tension_angle;  // s, deg
  Vec3 max_tension_place;                                     // m
  struct Event {
    double time = 0;              // s
    std::optional<double> angle;  // of the centroid, unwrapped, deg
    PassageEvent what = PassageEvent::entered;
  };
  std::vector<Event> events;
};

}  // namespace snag
