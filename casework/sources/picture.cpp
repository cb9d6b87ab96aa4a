// What the camera of [virtual_camera] sees of all pieces.
#include "casework/observable_source.hpp"
#include "simulation/output/outline_moments.hpp"

namespace snag {

namespace {

const bool registered = add_observable_source<Silhouette>({.in_memory = [](const RunInMemory& run) -> std::any {
  const RagSystem& rags = *run.simulation.rags;
  return outline_of_all(gather_sheet(rags), rags.rags(), run.view);
}});

}  // namespace

}  // namespace snag
