#include "diagnosis/data/experiment_table.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/sha256.hpp"
#include "base/words.hpp"
#include "observe/repeats.hpp"

namespace snag {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

template <class Number>
std::optional<Number> number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

class Reading {
 public:
  Reading(const std::string& name, const Experiment& experiment) : name_(name), experiment_(experiment) {
    for (const OperatingPoint& point : experiment.points) points_.emplace(point.id, static_cast<int>(points_.size()));
    for (const Observable& observable : experiment.observables) observables_.emplace(observable.id, static_cast<int>(observables_.size()));
  }

  DataTable read(std::string_view text) {
    DataTable table;
    std::string withheld;
    if (constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; text.starts_with(byte_order_mark))
      text.remove_prefix(byte_order_mark.size());
    while (!text.empty()) {
      const auto end = text.find('\n');
      const std::string_view line = trimmed(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++line_;
      if (line.empty() || line.front() == '#') continue;
      cut(line);
      if (columns_.empty()) {
        read_header();
        continue;
      }
      table.rows.push_back({datum(), line_});
      read_repeats(table.rows.back());
      if (experiment_.points[table.rows.back().datum.point].withheld) withheld.append(line).append("\n");
    }
    if (columns_.empty()) throw Error(ExitCode::usage, name_ + " is empty; write a line point,replicate,t_s,observable,value and rows");
    table.withheld_sha256 = sha256(withheld);
    return table;
  }

 private:
  Error wrong(const std::string& what) const { return {ExitCode::usage, name_ + ":" + std::to_string(line_) + ": " + what}; }

  std::string_view without_quotes(std::string_view field) const {
    if (!field.starts_with('"')) return field;
    if (field.size() < 2 || !field.ends_with('"'))
      throw wrong("a field in quotes holds a comma, or has no end: write numbers with a point, as in 0.5, and names without commas");
    return field.substr(1, field.size() - 2);
  }

  void cut(std::string_view line) {
    fields_.clear();
    for (std::size_t begin = 0;;) {
      const auto comma = line.find(',', begin);
      fields_.push_back(without_quotes(trimmed(line.substr(begin, comma - begin))));
      if (comma == std::string_view::npos) return;
      begin = comma + 1;
    }
  }

  void read_header() {
    static const std::vector<std::string> known{"point", "replicate", "t_s", "observable", "value", "censored", "n", "sd"};
    column_.assign(known.size(), -1);
    for (const auto& [character, meaning] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}})
      if (fields_.size() == 1 && fields_.front().find(character) != std::string_view::npos)
        throw wrong(std::string("the columns are separated by ") + meaning + "; separate them by commas, and write numbers with a point");
    for (const std::string_view field : fields_) {
      columns_.emplace_back(field);
      std::size_t k = 0;
      while (k < known.size() && known[k] != field) ++k;
      if (k == known.size())
        throw wrong("unknown column \"" + shortened(columns_.back()) +
                    "\"; the columns are point,replicate,t_s,observable,value and perhaps censored, n, sd");
      if (column_[k] >= 0) throw wrong("the column \"" + shortened(columns_.back()) + "\" is given twice");
      column_[k] = static_cast<int>(columns_.size()) - 1;
    }
    for (int k = 0; k < 5; ++k)
      if (column_[k] < 0) throw wrong("the column \"" + known[k] + "\" is missing; write point,replicate,t_s,observable,value");
  }

  std::string_view field(int k) const { return column_[k] < 0 ? std::string_view{} : fields_[column_[k]]; }

  int index(const std::map<std::string, int, std::less<>>& names, std::string_view text, const std::string& what) const {
    const auto found = names.find(text);
    if (found != names.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [name, i] : names) known.push_back(shortened(name));
    const std::string near = nearest_name(text, known);
    throw wrong("unknown " + what + " \"" + shortened(text) + "\"" + (near.empty() ? "" : "; did you mean \"" + near + "\"?") +
                "; DIAGNOSIS.toml has " + joined(known));
  }

  Datum datum() const {
    if (fields_.size() != columns_.size())
      throw wrong(std::to_string(fields_.size()) + " fields, but the first line has " + std::to_string(columns_.size()));
    Datum d;
    d.point = index(points_, field(0), "point");
    d.observable = index(observables_, field(3), "observable");
    const auto replicate = number<int>(field(1));
    if (!replicate || *replicate < 0) throw wrong("replicate \"" + shortened(field(1)) + "\" must be a whole number, 0 or more");
    d.replicate = *replicate;
    if (!field(2).empty()) {
      const auto time = number<double>(field(2));
      if (!time || !std::isfinite(*time))
        throw wrong("t_s \"" + shortened(field(2)) + "\" must be a finite number of seconds, or empty for a scalar of the replicate");
      d.time = *time;
    }
    const auto value = number<double>(field(4));
    if (!value || !(std::abs(*value) <= largest_measured))
      throw wrong("value \"" + shortened(field(4)) + "\" of " + shortened(field(3)) + " must be a finite number of at most " +
                  number_text(largest_measured) + " in size; leave out rows without one");
    d.value = *value;
    const std::string_view censored = field(5);
    if (censored == "1" || censored == "true")
      d.censored = true;
    else if (!censored.empty() && censored != "0" && censored != "false")
      throw wrong("censored \"" + shortened(censored) + "\" must be 0 or 1");
    return d;
  }

  void read_repeats(DatumRow& row) const {
    if (!field(6).empty()) {
      constexpr int most = 1000000;
      const auto n = number<int>(field(6));
      if (!n || *n < 1 || *n > most) throw wrong("n \"" + shortened(field(6)) + "\" must be a whole number of repeats, 1 to a million");
      row.n = *n;
    }
    if (field(7).empty()) return;
    const auto sd = number<double>(field(7));
    if (!sd || !(*sd >= 0 && *sd <= largest_measured))
      throw wrong("sd \"" + shortened(field(7)) + "\" must be a standard deviation between repeats, 0 to " + number_text(largest_measured));
    if (row.n == 1) throw wrong("sd is given for one repeat, which has none; give their number n, or leave sd empty");
    row.sd = *sd;
  }

  const std::string& name_;
  const Experiment& experiment_;
  std::map<std::string, int, std::less<>> points_, observables_;
  std::vector<std::string> columns_;
  std::vector<int> column_;  // of point, replicate, t_s, observable, value, censored, n, sd; -1: absent
  std::vector<std::string_view> fields_;
  int line_ = 0;
};

}  // namespace

DataTable read_data_table(const std::string& text, const std::string& name, const Experiment& experiment) {
  DataTable table = Reading(name, experiment).read(text);
  table.data_sha256 = sha256(text);
  return table;
}

}  // namespace snag
