// Force of the first [[hold]] on the first piece, mean over the last step; zero at the start. A run in a folder has it in its monitor of
// the holds, by the same names.
#include <limits>

#include "casework/observable_source.hpp"

namespace snag {

namespace {

struct HoldForce {
  Vec3 force;  // N
};

HoldForce force_of(const Simulation& run) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (run.holds)
    for (const HoldReaction& reaction : run.holds->reactions(*run.rags, run.time()))
      if (reaction.hold == 0 && reaction.rag == 0) return {reaction.force};
  return {{none, none, none}};
}

template <int axis>
double component(const HoldForce& hold) {
  return hold.force[axis];
}

const bool registered =
    add_observable_source<HoldForce>({.in_memory = [](const RunInMemory& run) -> std::any { return force_of(run.simulation); }});
const bool group = add_observables(
    40, {{"force_x", "N", Measure::force, -1, component<0>, Needs::hold, "force of the first [[hold]] on the first piece"},
         {"force_y", "N", Measure::force, -1, component<1>, Needs::hold, "force of the first [[hold]] on the first piece"},
         {"force_z", "N", Measure::force, -1, component<2>, Needs::hold, "force of the first [[hold]] on the first piece"}});

}  // namespace

}  // namespace snag
