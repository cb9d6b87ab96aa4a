// What the camera of [virtual_camera] sees of all pieces.
#include "casework/observable_source.hpp"
#include "casework/outline_moments.hpp"

namespace snag {

namespace {

const bool registered = add_observable_source<Silhouette>(
    {.in_memory = [](const RunInMemory& run) -> std::any { return outline_of(*run.simulation.rags, run.view); }});

}  // namespace

}  // namespace snag
