#include "app/study_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/report/html.hpp"
#include "app/report/line_plot.hpp"
#include "app/report/page.hpp"
#include "base/atomic_file.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

using nlohmann::json;

/// "rags.0.outcome" of a summary; null if it is not there.
json looked_up(const json& summary, std::string key) {
  std::replace(key.begin(), key.end(), '.', '/');
  const json::json_pointer place("/" + key);
  return summary.contains(place) ? summary[place] : json();
}

/// One run as the table has it: its summary, and the values that vary.
struct Row {
  const StudyRun& run;
  json summary;
};

/// A value that varies, or a key of the summary.
json value_of(const Study& study, const Row& row, const std::string& name) {
  for (std::size_t v = 0; v < study.vary.size(); ++v)
    if (study.vary[v].name == name)
      return study.vary[v].values.empty() ? json(row.run.values[v]) : json(std::atof(row.run.values[v].c_str()));
  return looked_up(row.summary, name);
}

std::vector<std::string> columns_of(const Study& study) {
  std::vector<std::string> columns;
  for (const VarySettings& vary : study.vary) columns.push_back(vary.name);
  columns.emplace_back("exit");
  columns.insert(columns.end(), study.settings.results.begin(), study.settings.results.end());
  return columns;
}

/// A field of a CSV file: quoted where it must be.
std::string field(const json& value) {
  if (value.is_null()) return "";
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
  return '"' + text + '"';
}

std::string csv(const Study& study, const std::vector<Row>& rows) {
  std::string text = "run";
  for (const std::string& column : columns_of(study)) text += "," + field(column);
  for (const Row& row : rows) {
    text += "\n" + field(row.run.name);
    for (const std::string& column : columns_of(study)) text += "," + field(value_of(study, row, column));
  }
  return text + "\n";
}

std::string table(const Study& study, const std::vector<Row>& rows) {
  std::vector<std::string> header{"Run"};
  for (const std::string& column : columns_of(study)) header.push_back(escaped(column));
  std::vector<std::vector<std::string>> cells;
  for (const Row& row : rows) {
    cells.push_back({"<a href=\"" + escaped(row.run.name) + "/report.html\">" + escaped(row.run.name) + "</a>"});
    for (const std::string& column : columns_of(study)) {
      const json value = value_of(study, row, column);
      cells.back().push_back(value.is_number() ? html::number(value.get<double>()) : escaped(field(value)));
    }
  }
  return html::table(header, cells);
}

/// The runs side by side: a line for each result, a column for each run.
std::string side_by_side(const Study& study, const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> columns{{""}};
  for (const std::string& key : study.settings.results) columns[0].push_back(key);
  for (const Row& row : rows) {
    columns.push_back({row.run.name});
    for (const std::string& key : study.settings.results) {
      const json value = value_of(study, row, key);
      columns.back().push_back(value.is_null() ? "-" : value.is_number_float() ? words(value.get<double>()) : field(value));
    }
  }
  std::string text;
  for (std::size_t line = 0; line < columns[0].size(); ++line) {
    std::string cells;
    for (const auto& column : columns) {
      const auto widest = std::max_element(column.begin(), column.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
      cells += column[line] + std::string(widest->size() + 2 - column[line].size(), ' ');
    }
    text += (line > 0 ? "\n" : "") + cells.substr(0, cells.find_last_not_of(' ') + 1);
  }
  return text;
}

std::string plot(const Study& study, const StudyPlotSettings& settings, const std::vector<Row>& rows) {
  LinePlot result{settings.title,
                  settings.x_label.empty() ? settings.x : settings.x_label,
                  settings.y_label.empty() && !settings.y.empty() ? settings.y[0] : settings.y_label,
                  {}};
  for (const std::string& y : settings.y) {
    std::vector<std::pair<double, double>> points;
    for (const Row& row : rows)
      if (const json at = value_of(study, row, settings.x), value = value_of(study, row, y); at.is_number() && value.is_number())
        points.emplace_back(at.get<double>(), value.get<double>());
    std::sort(points.begin(), points.end());
    PlotLine line{settings.y.size() > 1 ? y : "", {}, {}};
    line.dotted = true;
    for (const auto& [at, value] : points) line.x.push_back(at), line.y.push_back(value);
    result.lines.push_back(std::move(line));
  }
  return figure(result);
}

}  // namespace

std::string write_study_results(const Study& study, const std::filesystem::path& folder) {
  std::vector<Row> rows;
  for (const StudyRun& run : study.runs)
    rows.push_back({run, json::parse(file_text(folder / run.name / "summary.json").value_or(""), nullptr, false)});
  write_atomically(folder / "study.csv", csv(study, rows));

  std::string plots;
  for (const StudyPlotSettings& settings : study.plots) plots += plot(study, settings, rows);
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Snag: " +
      escaped(study.settings.name) + "</title>\n<style>" + std::string(report_style) +
      "td:first-child { width: auto; }</style>\n</head>\n<body>\n<h1>" + escaped(study.settings.name) + "</h1>\n<p>" +
      escaped(study.settings.description) + "</p>\n";
  if (!plots.empty()) page += section("Plots", "<div class=\"plots\">\n" + plots + "</div>\n");
  page += section("Runs", table(study, rows));
  write_atomically(folder / "study.html", page + "</body>\n</html>\n");
  return side_by_side(study, rows);
}

}  // namespace snag
