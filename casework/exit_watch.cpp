#include "casework/exit_watch.hpp"

namespace snag {

void ExitWatch::add(double time, const Motion& centre) {
  if (!settings_.has_exit()) return;
  const double beyond = settings_.beyond_exit(centre.position);
  RagSnapshot seen;
  seen.n = 1, seen.n_out = beyond > 0 ? 1 : 0;
  if (before_ < 0 && beyond > 0) seen.out_after = before_ / (before_ - beyond);
  tracker_.add(seen, time, time - before_time_);
  before_ = beyond, before_time_ = time;
}

}  // namespace snag
