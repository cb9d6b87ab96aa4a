#pragma once
// The pump before, while and after a rag passes, from monitors/pump.csv: means over whole revolutions. What summary.json and the report say
// of it.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/series.hpp"

namespace snag {

/// Means of the pump over whole revolutions, SI.
struct PumpMeans {
  int revolutions = 0;
  double head = 0, torque = 0, shaft_power = 0;
};

/// Absent where it is not known.
struct PumpPassage {
  std::optional<PumpMeans> before, passing, after;
  /// Of a mean while the rag passes over that before, less 1.
  std::optional<double> change(double PumpMeans::*value) const;
};

/// The pump over the time of a run: the head of one instant says little where a single vane makes it swing, a revolution's mean does.
class PumpRecord {
 public:
  /// Empty if there is no pump.csv. Throws Error(io).
  explicit PumpRecord(const std::filesystem::path& monitors);
  bool empty() const { return time_.empty(); }
  const std::vector<double>& time() const { return time_; }
  const std::vector<double>& column(const std::string& name) const { return table_.column(name); }
  /// At each record the mean of a column over the revolution around it; NAN where that reaches beyond the run.
  std::vector<double> sliding_mean(const std::string& name) const;
  /// Around a rag that entered and left at these times, s. NAN: it did not; one that did not leave passes until the end of the run.
  PumpPassage passage(double entered, double exited) const;
  /// Up to three whole revolutions that end at a time, without the first one of a run, as far back as the head changes by at most 2 % from
  /// one to the next; none if these are less than two: a start from rest is no state to compare with.
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
