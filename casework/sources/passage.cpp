// Passage of the first rag: of a run in memory to the exit plane of its camera (casework/exit_watch.hpp), of a run in a folder from its
// summary.json.
#include "casework/observable_source.hpp"
#include "simulation/output/summary.hpp"

namespace snag {

namespace {

std::any of_folder(const std::filesystem::path& folder) {
  const auto passage = first_passage(folder / "summary.json");
  return passage ? std::any(*passage) : std::any();
}

const bool registered = add_observable_source<PassageResult>(
    {.in_memory = [](const RunInMemory& run) -> std::any { return run.exit.verdict(); }, .in_folder = of_folder});

}  // namespace

}  // namespace snag
