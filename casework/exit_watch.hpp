#pragma once
// The passage of a run in memory: what the tracker of passages is shown of it.
//
//   exit plane   [virtual_camera] exit_point, exit_normal: the centre of mass of all pieces is seen as one point, which is wholly in from
//   the start
//                and out beyond the plane. The time of the exit is linear in its distance from the plane within the step, so that
//                derivatives by differences of runs are smooth
//   without it   the openings of the mesh, if there are any, see the particles of the first piece, as in a run in a folder
#include "observe/observables.hpp"
#include "observe/passage/passage_tracker.hpp"
#include "simulation/setup/observe_settings.hpp"
#include "simulation/setup/passage.hpp"

namespace snag {

class ExitWatch {
 public:
  ExitWatch(const ObserveSettings& settings, const Passage& openings)
      : settings_(settings), openings_(openings), tracker_(Passageway::plane) {}
  /// The centre at the end of a step, or at the start; times in order, s.
  void add(double time, const Motion& centre);
  PassageResult verdict() const { return settings_.has_exit() ? tracker_.verdict() : openings_.verdict(0); }

 private:
  const ObserveSettings& settings_;
  const Passage& openings_;
  PassageTracker tracker_;
  double before_ = 0, before_time_ = 0;  // distance beyond the plane, m; s
};

}  // namespace snag
