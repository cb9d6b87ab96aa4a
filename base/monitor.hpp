#pragma once
// A monitor whose columns are declared once: name, unit and the value that a record has there.
#include <functional>
#include <utility>

#include "base/series.hpp"

namespace snag {

template <class Record>
struct Column {
  std::string name, unit;
  std::function<double(const Record&)> value;
};

template <class Record>
class Monitor {
 public:
  Monitor() = default;
  /// `columns`: the time in s first. On a resume lines with a time > from_time are cut and the header must match. Throws Error(io).
  Monitor(const std::filesystem::path& file, std::vector<Column<Record>> columns, bool resume = false, double from_time = 0)
      : columns_(std::move(columns)), series_(file, names(columns_), resume, from_time) {}
  /// One line; see Series::add.
  void add(const Record& record) {
    std::vector<double> values;
    values.reserve(columns_.size());
    for (const Column<Record>& column : columns_) values.push_back(column.value(record));
    series_.add(values);
  }
  const Series& series() const { return series_; }

 private:
  static std::vector<std::string> names(const std::vector<Column<Record>>& columns) {
    std::vector<std::string> all;
    for (const Column<Record>& column : columns) all.push_back(column.name + " [" + column.unit + "]");
    return all;
  }

  std::vector<Column<Record>> columns_;
  Series series_;
};

/// Three columns of a vector; `vector` gives it from a record.
template <class Record, class Vector>
void add_components(std::vector<Column<Record>>& columns, const std::string& before, const std::string& after, const std::string& unit,
                    Vector vector) {
  for (int axis = 0; axis < 3; ++axis)
    columns.push_back({before + "xyz"[axis] + after, unit, [=](const Record& record) { return vector(record)[axis]; }});
}

}  // namespace snag
