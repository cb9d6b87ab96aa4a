#pragma once
// When a checkpoint of a run is due: by simulated time, or by the wall clock of rank 0.
#include "simulation/setup/simulation.hpp"

namespace snag {

class CheckpointClock {
 public:
  /// `simulation`: must outlive this object.
  explicit CheckpointClock(const Simulation& simulation);
  /// The interval of one of the two clocks is over since the last time that it was. Collective.
  bool is_due();

 private:
  const Simulation& simulation_;
  double last_time_, last_wall_;  // s
};

}  // namespace snag
