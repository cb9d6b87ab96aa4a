#include "report/report.hpp"

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/version.hpp"
#include "base/words.hpp"
#include "report/html.hpp"
#include "report/links.hpp"
#include "report/monitor_plots.hpp"
#include "report/page.hpp"
#include "report/passage_section.hpp"
#include "report/pictures.hpp"
#include "report/pump_section.hpp"
#include "report/results.hpp"
#include "report/step_section.hpp"

namespace snag {

namespace {

constexpr std::size_t log_tail = 6000;                                 // bytes
constexpr std::size_t time_stamp = sizeof("2026-01-01 00:00:00") - 1;  // of a line of the log

std::string problem(const std::string& text) { return "<p class=\"problem\">" + escaped(text) + "</p>\n"; }

struct PictureParts {
  std::string instants, others, unreadable;  // of the rags; of the water and the walls
};

PictureParts picture_parts(const Pictures& pictures) {
  PictureParts parts;
  std::string small, scale, path;
  bool is_pump = false;
  for (const auto& picture : pictures.made) {
    is_pump = is_pump || picture.group == "pump";
    try {
      const auto caption = escaped(picture.caption);
      const auto image = "<img src=\"" + html::embedded_png(picture.file) + "\" alt=\"" + caption + "\">";
      const auto wide = "<figure class=\"wide\">" + image + "<figcaption>" + caption + "</figcaption></figure>\n";
      if (picture.group == "rag" || picture.group == "pump")  // time and events stand in the picture
        small += "<figure>" + image + "</figure>\n";
      else if (picture.group == "scale")
        scale += "<figure class=\"scale\">" + image + "</figure>\n";
      else if (picture.group == "path")
        path += "<figure class=\"path\">" + image + "<figcaption>" + caption + "</figcaption></figure>\n";
      else
        parts.others += wide;
    } catch (const Error& error) {
      parts.unreadable += problem(error.what());
    }
  }
  if (!small.empty())
    parts.instants =
        "<p>The rag is drawn over walls and water so that nothing hides it; its colour is the tension of its bonds. " +
        std::string(is_pump ? "The pump is seen from its inlet, through its walls, with the impeller at its angle."
                            : "Walls are transparent, and a plane through the middle of the domain shows the speed of the water.") +
        " All instants have the same view and scale; an event is named in the first picture after it.</p>\n"
        "<div class=\"pictures\">\n" +
        small + "</div>\n" + scale + path;
  return parts;
}

std::string plot_section(const MonitorPlots& monitors) {
  std::string content;
  for (const auto& plot : monitors.plots) content += figure(plot);
  if (!content.empty()) content = "<div class=\"plots\">\n" + content + "</div>\n";
  std::vector<std::vector<std::string>> constants;
  for (const auto& [title, value] : monitors.constants) constants.push_back({escaped(title), html::number(value)});
  if (!constants.empty()) content += html::table({"Constant throughout the run", "Value"}, constants);
  for (const auto& text : monitors.problems) content += problem("A monitor could not be drawn: " + text);
  return content;
}

std::string paraview_section(const std::filesystem::path& dir) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const char* file, const char* meaning) {
    if (std::filesystem::exists(dir / file)) rows.push_back({std::string("<code>") + file + "</code>", meaning});
  };
  add("fields/water.pvd", "water: velocity, pressure and the part of each cell that is cloth, over time");
  add("rags/rags.pvd", "rags: sheets with the velocity of their particles and the tension of their bonds, over time");
  add("walls/walls.vtp", "walls");
  add("walls/walls.pvd", "walls with the pressure on them, over time");
  if (rows.empty()) return "";
  return "<p>Open these files of the run's folder in ParaView (File, Open; then Apply). Colour the rag by tension, give the walls an "
         "opacity of 0.1, and "
         "put a Slice through the water. Numbers over time are in <code>monitors/*.csv</code>, which any spreadsheet reads.</p>\n" +
         html::table({"File", "content"}, rows);
}

std::string folded(const std::string& title, const std::string& text) {
  return text.empty() ? "" : "<details><summary>" + title + "</summary>\n<pre>" + escaped(text) + "</pre></details>\n";
}

std::string tail(const std::string& text) {
  if (text.size() <= log_tail) return text;
  const auto line = text.find('\n', text.size() - log_tail);
  return "...\n" + text.substr(line == std::string::npos ? text.size() - log_tail : line + 1);
}

/// Each warning of the log once, in the order in which they came.
std::string warning_list(const std::string& log) {
  static const std::string mark = " warning: ";
  std::vector<std::string> found;
  for (const std::string& line : split(log, '\n')) {
    const auto at = line.find(mark);
    if (at != time_stamp) continue;
    const std::string text = line.substr(at + mark.size());
    if (std::find(found.begin(), found.end(), text) == found.end()) found.push_back(text);
  }
  std::string list;
  for (const std::string& text : found) list += "<li>" + escaped(text) + "</li>\n";
  return list.empty() ? "" : "<ul>\n" + list + "</ul>\n";
}

std::string today() {
  char text[32] = "";
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", localtime_r(&now, &local));
  return text;
}

std::string missing(const Pictures& pictures) {
  if (pictures.problem.empty()) return "";
  return problem((pictures.made.empty() ? "There are no pictures: " : "Some pictures are missing: ") + pictures.problem);
}

/// The results may come from another program, or somebody has changed them.
std::string unreadable(const std::string& part, const nlohmann::json::exception& failure) {
  return problem(part + " cannot be shown: summary.json has other values than a run writes (" + failure.what() +
                 "); take the summary.json of the run, or run the case again");
}

std::string step_section_of(const nlohmann::json& summary) {
  try {
    return step_section(summary);
  } catch (const nlohmann::json::exception& failure) {
    return unreadable("The choice of the time step", failure);
  }
}

/// Rags in a pump: what is known of their passage.
struct Passages {
  std::string verdict, section;
  ColumnsByMonitor shown;  // of the monitors
};

Passages passages_of(const nlohmann::json& summary, const std::filesystem::path& dir) {
  try {
    const auto passages = rag_passages(summary, dir / "monitors");
    if (passages.empty()) return {};
    const PumpRecord pump(dir / "monitors");
    return {passage_verdict(passages, pump), passage_section(passages, pump, file_text(dir / "case.resolved.toml").value_or("")),
            passage_columns()};
  } catch (const Error& error) {
    return {"", problem("The passage of the rags could not be drawn: " + std::string(error.what())), {}};
  } catch (const nlohmann::json::exception& failure) {
    return {"", unreadable("The passage of the rags", failure), {}};
  }
}

std::string heading(const nlohmann::json& summary, const std::string& title, const std::string& verdict) {
  std::string content = "<h1>" + escaped(title) + "</h1>\n<p class=\"origin\">Report of a Snag run, made " + today() + " by version " +
                        version_number + " (" + version_git + ")</p>\n";
  if (summary.is_object())
    return content + "<p class=\"outcome" + (ended_well(summary) ? "" : " bad") + "\">" + outcome_sentence(summary, verdict) + "</p>\n";
  return content +
         "<p class=\"outcome bad\">The run left no readable summary.json: it is still going on, or it was killed. What follows is what it "
         "has "
         "written so far.</p>\n";
}

}  // namespace

void write_report(const std::filesystem::path& dir) {
  if (!std::filesystem::is_directory(dir)) throw Error(ExitCode::io, dir.string() + ": is not a folder; give the folder of --out");
  require_no_outward_links(dir);
  const auto summary = nlohmann::json::parse(file_text(dir / "summary.json").value_or(""), nullptr, false);
  if (!summary.is_object() && !std::filesystem::exists(dir / "monitors") && !std::filesystem::exists(dir / "case.resolved.toml"))
    throw Error(ExitCode::io, dir.string() +
                                  ": has neither summary.json, monitors nor case.resolved.toml, it must be the output folder of a run; "
                                  "give the folder of --out");
  const bool is_named = summary.is_object() && summary.contains("case") && summary["case"].is_string();
  const std::string title = is_named ? summary["case"].get<std::string>() : std::filesystem::weakly_canonical(dir).filename().string();

  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Snag: " +
      escaped(title) + "</title>\n<style>" + std::string(report_style) + "</style>\n</head>\n<body>\n";
  const Passages passages = passages_of(summary, dir);
  const Pictures pictures = draw_pictures(dir);
  const PictureParts drawn = picture_parts(pictures);
  const bool is_passage = !passages.section.empty();
  page += heading(summary, title, passages.verdict);
  const std::string log = file_text(dir / "log.txt").value_or("");
  page += section("Run summary", run_table(summary));
  page += section("Warnings", warning_list(log));
  if (is_passage) page += section("Passage of the rag through the pump", drawn.instants + passages.section);
  page += section("Pump", pump_section(summary, dir / "monitors"));
  page += section("Time step", step_section_of(summary));
  page += section("Balances", balance_tables(summary));
  page += section("Walls", wall_table(summary));
  page += section("Rags", rag_tables(summary));
  page += section("Conservation and sanity checks", check_table(summary));
  page += section("Pictures", (is_passage ? "" : drawn.instants) + drawn.others + drawn.unreadable + missing(pictures));
  page += section("Over time", plot_section(monitor_plots(dir / "monitors", passages.shown)));
  page += section("Computing cost", cost_table(summary));
  page += section("A closer look with ParaView", paraview_section(dir));
  page += section("The case and the log",
                  folded("The case with all its defaults (case.resolved.toml)", file_text(dir / "case.resolved.toml").value_or("")) +
                      folded("The end of the log (log.txt)", tail(log)));
  page += "</body>\n</html>\n";
  write_atomically(dir / "report.html", page);
}

Film make_film(const std::filesystem::path& dir) {
  require_no_outward_links(dir);
  const Pictures pictures = draw_film(dir);
  return {pictures.made.size(), pictures.problem};
}

}  // namespace snag
