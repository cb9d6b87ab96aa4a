#pragma once
// A rag's way through the pump, from monitors/passage.csv, rag_forces.csv and the events of summary.json: what the sentences, tables
// and plots of the report share.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/series.hpp"

namespace snag {

struct RagEvent {
  double time = 0;   // s
  std::string what;  // as the file says
};

struct RagPassage {
  int id = 0;
  nlohmann::json summary;        // of this rag; null if there is none
  SeriesTable way;               // its records of passage.csv, at least one
  SeriesTable forces;            // its records of rag_forces.csv; empty if there is none
  std::vector<RagEvent> events;  // as they happened
  // s; NAN: it did not happen, or is not known
  double entered = 0, wholly_in = 0, exited = 0;
  double touching_impeller = 0, touching_tongue = 0;  // s, of at least one particle: as summary.json says, else by passage.csv
};

/// In the order of the rags; empty if there is no passage.csv. Throws Error(io) if a monitor cannot be read.
std::vector<RagPassage> rag_passages(const nlohmann::json& summary, const std::filesystem::path& monitors);

}  // namespace snag
