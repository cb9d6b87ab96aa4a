#include "base/series.hpp"

#include <fcntl.h>

#include <charconv>
#include <cstdio>
#include <fstream>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/csv.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

std::string header_line(const std::vector<std::string>& columns) {
  std::string line;
  for (const auto& column : columns) line += (line.empty() ? "" : ",") + csv_field(column);
  return line;
}

/// The numbers of a line, or nothing if it is not n of them.
std::optional<std::vector<double>> numbers(const std::string& line, std::size_t n) {
  const auto parts = split(line, ',');
  if (parts.size() != n) return {};
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    const char *begin = parts[i].data(), *end = begin + parts[i].size();
    const auto [stop, failure] = std::from_chars(begin, end, values[i]);
    if (failure != std::errc() || stop != end) return {};
  }
  return values;
}

/// Calls `record` with each complete line behind the header and its numbers; returns the header.
/// A last line without its end was cut off when a run was stopped, and is passed over.
template <class Record>
std::string for_each_record(const std::filesystem::path& file, Record record) {
  std::ifstream in(file);
  if (!in) throw Error(ExitCode::io, file.string() + ": cannot be read; is this the folder of a run?");
  std::string header, line;
  if (!std::getline(in, header) || in.eof()) return "";
  const auto n_columns = csv_fields(header).size();
  for (std::size_t number = 2; std::getline(in, line) && !in.eof(); ++number) {
    const auto values = numbers(line, n_columns);
    if (!values)
      throw Error(ExitCode::io, file.string() + ":" + std::to_string(number) + ": \"" + shortened(line) + "\" is not " +
                                    std::to_string(n_columns) + " numbers separated by commas; repair or remove the line");
    record(line, *values);
  }
  return header;
}

}  // namespace

Series::Series(const std::filesystem::path& file, std::vector<std::string> columns, bool resume, double from_time)
    : path_(file), columns_(std::move(columns)) {
  for (const auto& column : columns_)
    if (column.empty() || column.find_first_of("\n\r") != std::string::npos)
      throw Error(ExitCode::io,
                  file.string() + ": column name \"" + shortened(column) + "\" is empty or has several lines; choose another name");
  const std::string header = header_line(columns_);
  std::string kept = header + "\n";
  const bool found_before = std::filesystem::exists(file);
  if (resume && from_time > 0 && !found_before)
    log::warning(file.string() + ": does not exist, so records up to " + number_text(from_time) + " s are lost; a new file is started");
  if (resume && found_before) {
    const auto found = for_each_record(file, [&](const std::string& line, const std::vector<double>& values) {
      if (!is_later(values[0], from_time)) kept += line + "\n";
    });
    if (!found.empty() && found != header)
      throw Error(ExitCode::io, file.string() + ": has the columns \"" + found + "\", this run writes \"" + header +
                                    "\"; resume with the same program and case, or move the file away");
  }
  write_atomically(file, kept);
  file_ = OpenFile(file, O_WRONLY | O_APPEND);
}

void Series::add(const std::vector<double>& values) {
  if (values.size() != columns_.size())
    throw Error(ExitCode::io, "monitor of \"" + header_line(columns_) + "\": " + std::to_string(values.size()) + " values, needs " +
                                  std::to_string(columns_.size()));
  std::string line;
  char number[32];
  for (const double value : values) {
    const int length = std::snprintf(number, sizeof number, "%.17g", value);
    if (!line.empty()) line += ',';
    line.append(number, length);
  }
  line += '\n';
  if (!failure_.empty()) return;
  try {
    file_.write(line);
  } catch (const Error& failure) {
    failure_ = failure.what();
  }
}

void Series::check() const {
  if (file_.descriptor() < 0) return;
  if (!failure_.empty()) throw Error(ExitCode::io, failure_);
  if (file_.is_removed())
    throw Error(ExitCode::io, path_.string() +
                                  ": was removed while the run was writing to it, its records are lost; restore it if you can, "
                                  "then go on from the last checkpoint with --resume, or run anew with --overwrite");
}

void Series::sync() const {
  if (file_.descriptor() >= 0) file_.sync();
}

const std::vector<double>& SeriesTable::column(const std::string& name) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == name || columns[i].starts_with(name + " [")) return values[i];
  throw Error(ExitCode::io, "monitor: no column \"" + name + "\"; there are: " + header_line(columns));
}

SeriesTable read_series(const std::filesystem::path& file) {
  std::vector<std::vector<double>> records;
  SeriesTable table;
  const std::string header =
      for_each_record(file, [&](const std::string&, const std::vector<double>& values) { records.push_back(values); });
  if (!header.empty()) table.columns = csv_fields(header);
  table.values.resize(table.columns.size());
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    for (const auto& record : records) table.values[i].push_back(record[i]);
  return table;
}

SeriesTable recorded(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return {};
  SeriesTable table = read_series(file);
  return table.values.empty() || table.values[0].empty() ? SeriesTable{} : table;
}

}  // namespace snag
