// Repeats as text: the table that is read, the tables and lines that are written.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/atomic_file.hpp"
#include "base/csv.hpp"
#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"
#include "observe/repeats.hpp"

namespace snag {

namespace {

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields = csv_fields(line);
  for (std::string& field : fields) field = trimmed(field);
  return fields;
}

/// "area [m2]"
Quantity quantity_of(const std::string& column) {
  const auto bracket = column.find(" [");
  if (bracket == std::string::npos || column.back() != ']') return {column, "1"};
  return {column.substr(0, bracket), column.substr(bracket + 2, column.size() - bracket - 3)};
}

class Reading {
 public:
  explicit Reading(std::string name) : name_(std::move(name)) {}

  void add(const std::string& line) {
    ++line_;
    if (trimmed(line).empty() || trimmed(line).front() == '#') return;
    const std::vector<std::string> fields = fields_of(line);
    columns_.empty() ? read_header(fields) : read_row(fields);
  }

  Repeats finish() {
    if (columns_.empty()) refuse("is empty; write a line group,rag,area [m2] and a row a sample");
    return repeats_;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ExitCode::usage, name_ + (line_ > 0 ? ":" + std::to_string(line_) : "") + ": " + what);
  }

  void read_header(const std::vector<std::string>& fields) {
    columns_ = fields;
    for (const std::string& column : columns_) {
      if (column.empty()) refuse("a column has no name");
      if (std::count(columns_.begin(), columns_.end(), column) > 1) refuse("the column \"" + shortened(column) + "\" is given twice");
      if (column == "group" || column == "rag") continue;
      repeats_.quantities.push_back(quantity_of(column));
      if (repeats_.quantities.back().is_axis() && repeats_.quantities.back().unit != "deg")
        refuse("the column \"" + shortened(column) + "\" must be in degrees; write orientation [deg]");
    }
    if (std::find(columns_.begin(), columns_.end(), "group") == columns_.end())
      refuse("there is no column \"group\" (" + shortened(joined(columns_)) + "); name the operating point of each row");
    if (repeats_.quantities.empty()) refuse("there is no column of values, only group and rag; add one, such as area [m2]");
  }

  void read_row(const std::vector<std::string>& fields) {
    if (fields.size() != columns_.size())
      refuse(std::to_string(fields.size()) + " fields, but the first line has " + std::to_string(columns_.size()));
    Repeats::Row row;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      if (columns_[k] != "group" && columns_[k] != "rag") {
        row.values.push_back(value(columns_[k], fields[k]));
        continue;
      }
      if (fields[k].empty()) refuse(columns_[k] + " is empty; name it");
      if (columns_[k] == "rag") row.rag = rags_.emplace(fields[k], static_cast<int>(rags_.size())).first->second;
      if (columns_[k] == "group") row.group = group(fields[k]);
    }
    repeats_.rows.push_back(std::move(row));
  }

  double value(const std::string& column, const std::string& field) const {
    double number = 0;
    const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (code != std::errc() || end != field.data() + field.size() || !(std::abs(number) <= largest_measured))
      refuse(shortened(column) + " \"" + shortened(field) + "\" must be a finite number of at most " + number_text(largest_measured) +
             " in size; leave out rows without one");
    return number;
  }

  int group(const std::string& name) {
    auto& groups = repeats_.groups;
    const auto found = std::find(groups.begin(), groups.end(), name);
    if (found == groups.end()) groups.push_back(name);
    return static_cast<int>(std::find(groups.begin(), groups.end(), name) - groups.begin());
  }

  std::string name_;
  int line_ = 0;
  std::vector<std::string> columns_;
  std::map<std::string, int> rags_;
  Repeats repeats_;
};

const char* name(Dependence dependence) {
  if (dependence == Dependence::intraclass) return "intraclass";
  return dependence == Dependence::autocorrelation ? "autocorrelation" : "none";
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

}  // namespace

Repeats read_repeats(const std::filesystem::path& file) {
  const auto text = file_text(file);
  if (!text) throw Error(ExitCode::io, file.string() + ": the table cannot be read; check the path");
  Reading reading(file.string());
  for (const std::string& line : split(*text, '\n')) reading.add(line);
  return reading.finish();
}

std::string groups_csv(const std::vector<GroupComparison>& comparisons, const Repeats& repeats) {
  std::string text = "quantity,unit,group,mean,sigma,n,n_eff\n";
  for (const GroupComparison& c : comparisons)
    for (std::size_t g = 0; g < c.groups.size(); ++g)
      text += csv_field(c.quantity.name) + "," + csv_field(c.quantity.unit) + "," + csv_field(repeats.groups[g]) + "," +
              number(c.groups[g].values.mean) + "," + number(c.groups[g].values.sigma) + "," + number(c.groups[g].n) + "," +
              number(c.groups[g].n_independent) + "\n";
  return text;
}

std::string anova_csv(const std::vector<GroupComparison>& comparisons) {
  std::string text = "quantity,F,p,F_eff,p_eff,dependence,correlation\n";
  for (const GroupComparison& c : comparisons) {
    const Anova eff = c.by_independent.value_or(Anova{std::nan(""), std::nan("")});
    text += csv_field(c.quantity.name) + "," + number(c.by_count.F) + "," + number(c.by_count.p) + "," + number(eff.F) + "," +
            number(eff.p) + "," + name(c.dependence) + "," + number(c.correlation) + "\n";
  }
  return text;
}

std::string words_of(const std::vector<GroupComparison>& comparisons) {
  std::string text;
  for (const GroupComparison& c : comparisons) {
    double n = 0, n_independent = 0;
    for (const auto& group : c.groups) n += group.n, n_independent += group.n_independent;
    text += (text.empty() ? "" : "\n") + c.quantity.name + ": p " + number_text(c.by_count.p) + " (F " + number_text(c.by_count.F) +
            ") as if all " + number_text(n) + " samples were independent; ";
    if (c.by_independent)
      text += "p " + number_text(c.by_independent->p) + " (F " + number_text(c.by_independent->F) + ") with the " +
              number_text(n_independent) + " that are";
    else
      text += "no p with the " + number_text(n_independent) + " that are: too few";
  }
  return text;
}

}  // namespace snag
