#include "report/study_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/csv.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "report/html.hpp"
#include "report/key_words.hpp"
#include "report/line_plot.hpp"
#include "report/monitor_plots.hpp"
#include "report/page.hpp"
#include "report/pictures.hpp"
#include "report/plateau_section.hpp"

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
  if (name == "exit" && !row.summary.is_object()) return row.run.failed_with > 0 ? json(row.run.failed_with) : json();
  return looked_up(row.summary, name);
}

/// What a column is called, with its unit; that of a value that varies comes from its key.
std::string label_of(const Study& study, const std::string& name) {
  for (const VarySettings& vary : study.vary)
    if (vary.name == name) {
      const KeyWords words = words_of_key(vary.key);
      const bool is_named = vary.name != split(vary.key, '.').back();
      return KeyWords{is_named ? vary.name : words.title, vary.values.empty() ? "" : words.unit}.label();
    }
  return words_of_key(name).label();
}

std::vector<std::string> columns_of(const Study& study) {
  std::vector<std::string> columns;
  for (const VarySettings& vary : study.vary) columns.push_back(vary.name);
  columns.emplace_back("exit");
  columns.insert(columns.end(), study.settings.results.begin(), study.settings.results.end());
  return columns;
}

std::string text_of(const json& value) { return value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump(); }

std::string csv(const Study& study, const std::vector<Row>& rows) {
  std::string text = "run";
  for (const std::string& column : columns_of(study)) text += "," + csv_field(column);
  for (const Row& row : rows) {
    text += "\n" + csv_field(row.run.name);
    for (const std::string& column : columns_of(study)) text += "," + csv_field(text_of(value_of(study, row, column)));
  }
  return text + "\n";
}

std::string table(const Study& study, const std::vector<Row>& rows) {
  std::vector<std::string> header{"Run"};
  for (const std::string& column : columns_of(study))
    header.push_back("<span title=\"" + escaped(column) + "\">" + escaped(label_of(study, column)) + "</span>");
  std::vector<std::vector<std::string>> cells;
  for (const Row& row : rows) {
    cells.push_back({"<a href=\"" + escaped(row.run.name) + "/report.html\">" + escaped(row.run.name) + "</a>"});
    for (const std::string& column : columns_of(study)) {
      const json value = value_of(study, row, column);
      cells.back().push_back(value.is_number() ? html::number(value.get<double>()) : escaped(text_of(value)));
    }
  }
  return "<div class=\"scroll\">" + html::table(header, cells) + "</div>\n";
}

/// The runs side by side: a line for each result, a column for each run.
std::string side_by_side(const Study& study, const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> columns{{""}};
  for (const std::string& key : study.settings.results) columns[0].push_back(key);
  for (const Row& row : rows) {
    columns.push_back({row.run.name});
    for (const std::string& key : study.settings.results) {
      const json value = value_of(study, row, key);
      columns.back().push_back(value.is_null() ? "-" : value.is_number_float() ? number_text(value.get<double>()) : text_of(value));
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

/// The values of a run of all that varies but `x` and, where asked for, but what is not physical: "kernel gaussian, radius_mm 2".
std::string group_of(const Study& study, const StudyRun& run, const std::string& x, const std::vector<std::string>* among = nullptr) {
  std::string group;
  for (std::size_t v = 0; v < study.vary.size(); ++v) {
    const std::string& name = study.vary[v].name;
    if (name == x || (among && std::find(among->begin(), among->end(), name) == among->end())) continue;
    group += (group.empty() ? "" : ", ") + name + " " + run.values[v];
  }
  return group;
}

/// Over a value that varies each combination of the others has a line of its own, unless these are more than a reader tells apart.
std::string plot(const Study& study, const StudyPlotSettings& settings, const std::vector<Row>& rows) {
  constexpr std::size_t most_lines = 12;
  LinePlot result{settings.title,
                  settings.x_label.empty() ? label_of(study, settings.x) : settings.x_label,
                  settings.y_label.empty() && !settings.y.empty() ? label_of(study, settings.y[0]) : settings.y_label,
                  {}};
  const bool varies = std::any_of(study.vary.begin(), study.vary.end(), [&](const VarySettings& vary) { return vary.name == settings.x; });
  for (const std::string& y : settings.y) {
    std::vector<std::pair<std::string, std::vector<std::pair<double, double>>>> lines;
    for (const Row& row : rows)
      if (const json at = value_of(study, row, settings.x), value = value_of(study, row, y); at.is_number() && value.is_number()) {
        const std::string group = varies && !study.settings.zip ? group_of(study, row.run, settings.x) : "";
        auto line = std::find_if(lines.begin(), lines.end(), [&](const auto& known) { return known.first == group; });
        if (line == lines.end()) line = lines.insert(lines.end(), {group, {}});
        line->second.emplace_back(at.get<double>(), value.get<double>());
      }
    if (lines.size() * settings.y.size() > most_lines)
      for (; lines.size() > 1; lines.pop_back())
        lines[0].first.clear(), lines[0].second.insert(lines[0].second.end(), lines.back().second.begin(), lines.back().second.end());
    for (auto& [group, points] : lines) {
      std::sort(points.begin(), points.end());
      const std::string of_y = settings.y.size() > 1 ? label_of(study, y) : "";
      PlotLine line{of_y + (of_y.empty() || group.empty() ? "" : ", ") + group, {}, {}};
      line.dotted = true;
      for (const auto& [at, value] : points) line.x.push_back(at), line.y.push_back(value);
      result.lines.push_back(std::move(line));
    }
  }
  return figure(result);
}

/// Plots that a study file does not ask for: each number over the one value that varies, where that is a number.
std::vector<StudyPlotSettings> plots_of(const Study& study) {
  std::vector<StudyPlotSettings> plots = study.plots;
  if (!plots.empty() || study.vary.size() != 1 || study.vary[0].values.size() < 2) return plots;
  for (const std::string& key : study.settings.results) plots.push_back({words_of_key(key).title, study.vary[0].name, "", "", {key}});
  return plots;
}

/// The plateau that the study file asks for, and what it was looked for in.
std::pair<PlateauQuestion, Plateau> plateau_of(const Study& study, const std::vector<Row>& rows) {
  const PlateauSettings& settings = *study.plateau;
  PlateauQuestion question{settings, {}, {}};
  for (const VarySettings& vary : study.vary)
    if (vary.name == settings.x) question.x = words_of_key(vary.key);
  for (const std::string& key : settings.results) question.results.push_back(label_of(study, key));
  std::vector<PlateauRun> runs;
  for (const Row& row : rows) {
    PlateauRun run{value_of(study, row, settings.x).get<double>(),
                   group_of(study, row.run, settings.x),
                   group_of(study, row.run, settings.x, &settings.physical),
                   {}};
    const bool went_well = row.summary.is_object() && row.summary.value("exit", -1) == 0;
    for (const std::string& key : settings.results) {
      const json value = went_well ? looked_up(row.summary, key) : json();
      run.results.push_back(value.is_number() ? std::optional(value.get<double>()) : std::nullopt);
    }
    runs.push_back(std::move(run));
  }
  const Plateau plateau = find_plateau(runs, settings.tolerance, static_cast<std::size_t>(settings.n_least));
  return {std::move(question), plateau};
}

/// The runs over time in common axes: the first line of some plots of their reports.
std::string overlays(const Study& study, const std::filesystem::path& folder) {
  constexpr std::size_t most_runs = 8;  // more lines than a reader tells apart
  if (study.runs.size() < 2 || study.runs.size() > most_runs) return "";
  std::vector<LinePlot> result;
  for (const char* title : {"Head of the pump", "Torque of the water on the impeller",
                            "Elongation ratio: long side over short side of the rag", "Largest strain of a bond"})
    result.push_back({title, "time [s]", "", {}});
  for (const StudyRun& run : study.runs)
    for (const LinePlot& own : monitor_plots(folder / run.name / "monitors").plots)
      for (LinePlot& plot : result)
        if (plot.title == own.title && !own.lines.empty()) {
          plot.lines.push_back(own.lines[0]);
          plot.lines.back().label = run.name;
          plot.y_label = own.y_label, plot.scale_from = std::max(plot.scale_from, own.scale_from);
        }
  std::string text;
  for (const LinePlot& plot : result)
    if (plot.lines.size() > 1) text += figure(plot);
  return text;
}

/// The last picture of each run's report that shows a rag or the water.
std::string pictures(const Study& study, const std::filesystem::path& folder) {
  constexpr std::size_t most_runs = 24;  // some 200 kB each
  std::string text;
  std::size_t n = 0;
  for (const StudyRun& run : study.runs) {
    const std::vector<Picture> there = pictures_there(folder / run.name);
    const auto last = std::find_if(there.rbegin(), there.rend(), [](const Picture& picture) {
      return picture.group == "path" || picture.group == "rag" || picture.group == "pump" || picture.group == "speed";
    });
    if (last == there.rend() || ++n > most_runs) continue;
    const std::string name = escaped(run.name);
    text += "<figure><a href=\"" + name + "/report.html\"><img src=\"" + html::embedded_png(last->file) + "\" alt=\"" + name +
            "\"></a><figcaption>" + name + ": " + escaped(last->caption) + "</figcaption></figure>\n";
  }
  if (n > most_runs) text += "<p>" + std::to_string(n - most_runs) + " more runs have pictures in their reports.</p>\n";
  return text.empty() ? "" : "<div class=\"pictures\">\n" + text + "</div>\n";
}

/// A column that is empty in every run that ended: a number of a rag that is not there, or a value that these runs do not have.
void warn_of_empty_columns(const Study& study, const std::vector<Row>& rows) {
  for (const std::string& key : study.settings.results) {
    const auto has = [&](const Row& row) { return !row.summary.is_object() || !looked_up(row.summary, key).is_null(); };
    if (std::none_of(rows.begin(), rows.end(), has))
      log::warning("[study] results: no run has a value of \"" + key + "\"; its column is empty");
  }
}

}  // namespace

std::string write_study_results(const Study& study, const std::filesystem::path& folder) {
  std::vector<Row> rows;
  for (const StudyRun& run : study.runs)
    rows.push_back({run, json::parse(file_text(folder / run.name / "summary.json").value_or(""), nullptr, false)});
  write_atomically(folder / "study.csv", csv(study, rows));
  warn_of_empty_columns(study, rows);

  std::string plots;
  for (const StudyPlotSettings& settings : plots_of(study)) plots += plot(study, settings, rows);
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Snag: " +
      escaped(study.settings.name) + "</title>\n<style>" + std::string(report_style) +
      "td:first-child { width: auto; white-space: nowrap; } th, td { overflow-wrap: normal; } .scroll { overflow-x: auto; "
      "}</style>\n</head>\n<body>\n<h1>" +
      escaped(study.settings.name) + "</h1>\n<p>" + escaped(study.settings.description) + "</p>\n";
  std::string finding;
  if (study.plateau) {
    const auto [question, plateau] = plateau_of(study, rows);
    page += section("Plateau", plateau_section(question, plateau));
    write_atomically(folder / "plateau.json", plateau_json(question, plateau).dump(2) + "\n");
    finding = "\n" + plateau_in_words(question, plateau);
  }
  if (!plots.empty()) page += section("Plots", "<div class=\"plots\">\n" + plots + "</div>\n");
  page += section("Runs", table(study, rows));
  const std::string over_time = overlays(study, folder);
  if (!over_time.empty()) page += section("The runs over time", "<div class=\"plots\">\n" + over_time + "</div>\n");
  page += section("Pictures", pictures(study, folder));
  write_atomically(folder / "study.html", page + "</body>\n</html>\n");
  return side_by_side(study, rows) + finding;
}

}  // namespace snag
