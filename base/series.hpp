#pragma once
// Monitors: one CSV file a series, header with units, a line a record, flushed; no line twice after a resume.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/open_file.hpp"

namespace snag {

/// True if `time` lies after `reference` by more than the round-off of a clock that adds up a great many steps.
inline bool is_later(double time, double reference) { return time - reference > 1e-9 * std::abs(reference); }

class Series {
 public:
  Series() = default;
  /// `columns`: "time [s]" first, each with its unit. On a resume lines with time > from_time are cut and the header must match. Throws
  /// Error(io).
  Series(const std::filesystem::path& file, std::vector<std::string> columns, bool resume = false, double from_time = 0);
  /// One record; as many values as columns; written with 17 significant digits. Only one rank writes: what it fails at is thrown by
  /// check(), so that all ranks can learn of it together.
  void add(const std::vector<double>& values);
  /// Throws Error(io) if a record could not be written, or the file was removed since it was opened. Nothing is checked before it is
  /// opened.
  void check() const;
  /// The disk has all records. Throws Error(io).
  void sync() const;
  const std::vector<std::string>& columns() const { return columns_; }

 private:
  std::filesystem::path path_;
  OpenFile file_;
  std::vector<std::string> columns_;
  std::string failure_;  // of the first record that could not be written
};

/// Columns of a CSV file that Series wrote.
struct SeriesTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;                           // [column][record]
  const std::vector<double>& column(const std::string& name) const;  // "head" finds "head [m]"; throws Error(io) listing the names
};
SeriesTable read_series(const std::filesystem::path& file);
/// The same, empty if the file is not there or holds no record. Throws Error(io) if it cannot be read.
SeriesTable recorded(const std::filesystem::path& file);

}  // namespace snag
