#pragma once
// A rag's way through the pump, from monitors/passage.csv, rag_forces.csv, pump.csv and the events of summary.json: what the sentences,
// tables and plots of the report share.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/series.hpp"

namespace snag {

struct RagEvent {
  double time = 0;  // s
  std::string what;
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

/// Means of the pump over whole revolutions, SI.
struct PumpMeans {
  int revolutions = 0;
  double head = 0, torque = 0, shaft_power = 0;
};

/// The pump over the time of a run: an instant's head tells little where a single vane makes it swing, a revolution's mean does.
class PumpRecord {
 public:
  /// Empty if there is no pump.csv. Throws Error(io).
  explicit PumpRecord(const std::filesystem::path& monitors);
  bool empty() const { return time_.empty(); }
  const std::vector<double>& time() const { return time_; }
  const std::vector<double>& column(const std::string& name) const { return table_.column(name); }
  /// At each record the mean of a column over the revolution around it; NAN where that reaches beyond the run.
  std::vector<double> sliding_mean(const std::string& name) const;
  /// Up to three whole revolutions that end at a time, without the first one of a run; none if there are less than two of them, or the head
  /// still changed by more than 2 % from one to the next: a start from rest is no state to compare with.
  std::optional<PumpMeans> before(double time) const;
  /// As many whole revolutions as fit between two times, at least one, around the middle of them.
  std::optional<PumpMeans> during(double begin, double end) const;
  /// Up to three whole revolutions that begin at a time.
  std::optional<PumpMeans> after(double time) const;
  /// s, of the last revolution; 0 if none is complete.
  double period() const;

 private:
  double revolution(double time) const;  // turned until then
  /// Mean of a column from one revolution to another, weighted by time.
  double mean(const std::string& name, double from, double to) const;
  std::optional<PumpMeans> means(double from, int n) const;

  SeriesTable table_;
  std::vector<double> time_, turned_;  // s, 1
};

}  // namespace snag
