#include "report/rag_passage.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "observe/outcome.hpp"

namespace snag {

namespace {

using nlohmann::json;

/// The records of each rag.
std::map<int, SeriesTable> by_rag(const SeriesTable& table) {
  std::map<int, SeriesTable> result;
  if (table.columns.empty()) return result;
  const auto& rag = table.column("rag");
  for (std::size_t i = 0; i < rag.size(); ++i) {
    SeriesTable& own = result[static_cast<int>(rag[i])];
    own.columns = table.columns;
    own.values.resize(table.columns.size());
    for (std::size_t c = 0; c < table.columns.size(); ++c) own.values[c].push_back(table.values[c][i]);
  }
  return result;
}

json rag_of(const json& summary, int id) {
  if (summary.is_object() && summary.contains("rags") && summary["rags"].is_array())
    for (const json& rag : summary["rags"])
      if (rag.is_object() && rag.contains("id") && rag["id"] == id) return rag;
  return {};
}

std::vector<RagEvent> events_of(const json& rag) {
  std::vector<RagEvent> events;
  if (!rag.is_object() || !rag.contains("events") || !rag["events"].is_array()) return events;
  for (const json& event : rag["events"])
    if (event.is_object() && event.contains("t_s") && event["t_s"].is_number())
      events.push_back({event["t_s"].get<double>(), event.value("what", "")});
  std::stable_sort(events.begin(), events.end(), [](const RagEvent& a, const RagEvent& b) { return a.time < b.time; });
  return events;
}

double time_of(const std::vector<RagEvent>& events, PassageEvent what) {
  const auto found = std::find_if(events.begin(), events.end(), [&](const RagEvent& event) { return event_named(event.what) == what; });
  return found == events.end() ? NAN : found->time;
}

/// Time, s, in which a count is above zero; a record stands for the step that ends with it.
double time_above_zero(const SeriesTable& table, const std::string& count) {
  const auto &time = table.values[0], &n = table.column(count);
  double sum = 0;
  for (std::size_t i = 1; i < time.size(); ++i)
    if (n[i] > 0) sum += time[i] - time[i - 1];
  return sum;
}

}  // namespace

std::vector<RagPassage> rag_passages(const json& summary, const std::filesystem::path& monitors) {
  std::vector<RagPassage> passages;
  auto forces = by_rag(recorded(monitors / "rag_forces.csv"));
  for (auto& [id, way] : by_rag(recorded(monitors / "passage.csv"))) {
    RagPassage passage;
    passage.id = id;
    passage.summary = rag_of(summary, id);
    passage.events = events_of(passage.summary);
    passage.entered = time_of(passage.events, PassageEvent::entered);
    passage.wholly_in = time_of(passage.events, PassageEvent::wholly_in);
    passage.exited = time_of(passage.events, PassageEvent::exited);
    const json zones = passage.summary.is_object() ? passage.summary.value("wall_contact_by_zone_s", json()) : json();
    const auto contact = [&](const char* zone, const char* count) {
      const bool is_told = zones.is_object() && zones.contains(zone) && zones[zone].is_number();
      return is_told ? zones[zone].get<double>() : time_above_zero(way, count);
    };
    passage.touching_impeller = contact("impeller", "touching_impeller");
    passage.touching_tongue = contact("tongue", "touching_tongue");
    passage.way = std::move(way);
    passage.forces = std::move(forces[id]);
    passages.push_back(std::move(passage));
  }
  return passages;
}

}  // namespace snag
