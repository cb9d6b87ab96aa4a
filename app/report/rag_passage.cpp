#include "app/report/rag_passage.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/report/monitor_plots.hpp"

namespace snag {

namespace {

using nlohmann::json;

constexpr int most_revolutions = 3;  // before and after a passage
constexpr double settled = 0.02;     // change of the head from one revolution to the next

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

double time_of(const std::vector<RagEvent>& events, const std::string& what) {
  const auto found = std::find_if(events.begin(), events.end(), [&](const RagEvent& event) { return event.what == what; });
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

/// y at an x between rising ones, linear; the first and last stretch reach beyond the ends.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.size() < 2) return y.at(0);
  const auto next = std::upper_bound(x.begin() + 1, x.end() - 1, at) - x.begin();
  const double width = x[next] - x[next - 1];
  return width > 0 ? y[next - 1] + (y[next] - y[next - 1]) * (at - x[next - 1]) / width : y[next];
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
    passage.entered = time_of(passage.events, "entered");
    passage.wholly_in = time_of(passage.events, "wholly in the casing");
    passage.exited = time_of(passage.events, "exited");
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

PumpRecord::PumpRecord(const std::filesystem::path& monitors) : table_(recorded(monitors / "pump.csv")) {
  if (table_.columns.empty()) return;
  time_ = table_.values[0];
  turned_ = table_.column("revolutions");
}

double PumpRecord::revolution(double time) const { return interpolated(time_, turned_, time); }

double PumpRecord::mean(const std::string& name, double from, double to) const {
  const auto& value = table_.column(name);
  double sum = 0, duration = 0;
  for (std::size_t i = 1; i < time_.size(); ++i)
    if (turned_[i] > from + 1e-9 && turned_[i] <= to + 1e-9)
      sum += value[i] * (time_[i] - time_[i - 1]), duration += time_[i] - time_[i - 1];
  return duration > 0 ? sum / duration : NAN;
}

std::optional<PumpMeans> PumpRecord::means(double from, int n) const {
  if (n < 1) return {};
  const auto of = [&](const char* name) { return mean(name, from, from + n); };
  return PumpMeans{n, of("head"), of("torque"), of("shaft_power")};
}

std::optional<PumpMeans> PumpRecord::before(double time) const {
  if (empty() || !std::isfinite(time)) return {};
  const double end = revolution(time), first = turned_.front();
  const int whole = static_cast<int>(std::floor(end - first + 1e-6)), n = std::min(most_revolutions, whole - 1);
  if (n < 2) return {};
  const double last = mean("head", end - 1, end), last_but_one = mean("head", end - 2, end - 1);
  if (std::abs(last - last_but_one) > settled * std::abs(last)) return {};
  return means(end - n, n);
}

std::optional<PumpMeans> PumpRecord::during(double begin, double end) const {
  if (empty() || !(begin < end)) return {};
  const double first = revolution(begin), last = revolution(end);
  const int n = std::max(1, static_cast<int>(std::floor(last - first + 1e-6)));
  double from = 0.5 * (first + last - n);
  from = std::min(from, turned_.back() - n);
  return from < turned_.front() - 1e-3 ? std::nullopt : means(from, n);
}

std::optional<PumpMeans> PumpRecord::after(double time) const {
  if (empty() || !std::isfinite(time)) return {};
  const double begin = revolution(time);
  return means(begin, std::min(most_revolutions, static_cast<int>(std::floor(turned_.back() - begin + 1e-6))));
}

double PumpRecord::period() const {
  return empty() || turned_.back() - turned_.front() < 1 ? 0 : time_.back() - interpolated(turned_, time_, turned_.back() - 1);
}

std::vector<double> PumpRecord::sliding_mean(const std::string& name) const {
  const auto& value = table_.column(name);
  std::vector<double> sum(time_.size(), 0), result(time_.size(), NAN);  // sum: integral over time, trapezoids
  for (std::size_t i = 1; i < time_.size(); ++i) sum[i] = sum[i - 1] + 0.5 * (value[i] + value[i - 1]) * (time_[i] - time_[i - 1]);
  for (std::size_t i = 0; i < time_.size(); ++i) {
    const double from = turned_[i] - 0.5, to = turned_[i] + 0.5;
    if (from < turned_.front() || to > turned_.back()) continue;
    result[i] = (interpolated(turned_, sum, to) - interpolated(turned_, sum, from)) /
                (interpolated(turned_, time_, to) - interpolated(turned_, time_, from));
  }
  return result;
}

}  // namespace snag
