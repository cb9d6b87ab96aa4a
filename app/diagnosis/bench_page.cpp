#include "app/diagnosis/bench_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "app/report/html.hpp"
#include "app/report/line_plot.hpp"
#include "app/report/page.hpp"
#include "base/version.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

std::string share_text(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", share);
  return std::isfinite(share) ? text : "-";
}

struct Line {
  std::string name, value, interval, target;
  int n = 0;
  bool met = true;
};

std::vector<Line> lines_of(const ScoreCard& card) {
  std::vector<Line> lines;
  for (const Score& s : card.scores)
    lines.push_back({s.name, std::to_string(s.hits) + " of " + std::to_string(s.n) + " = " + share_text(s.share()),
                     share_text(s.interval[0]) + " to " + share_text(s.interval[1]), s.target, s.n, s.met()});
  for (const Measure& m : card.measures)
    lines.push_back({m.name, share_text(m.value) + " of " + std::to_string(m.n) + " sets", "", m.target, m.n, m.met()});
  return lines;
}

std::string reliability(const ScoreCard& card) {
  LinePlot plot{.title = "Reliability",
                .x_label = "probability stated for the first hypothesis",
                .y_label = "share of them that was right",
                .lines = {}};
  PlotLine line{.label = "sets in bins of a tenth", .x = {}, .y = {}, .dotted = true};
  for (const auto& bin : card.reliability)
    if (bin.n > 0) line.x.push_back(bin.stated), line.y.push_back(bin.right);
  plot.lines = {line, {.label = "ideal", .x = {0, 1}, .y = {0, 1}, .faint = true}};
  return figure(plot);
}

/// Hits of single effects over the size of the gap, in bins of equal counts.
std::string detection(std::vector<ScoreRow> rows) {
  std::erase_if(rows, [](const ScoreRow& row) { return row.kind != "single"; });
  std::sort(rows.begin(), rows.end(), [](const ScoreRow& a, const ScoreRow& b) { return a.gap_over_floor < b.gap_over_floor; });
  PlotLine line{.label = "named first", .x = {}, .y = {}, .dotted = true};
  const std::size_t size = std::max<std::size_t>(5, rows.size() / 8);
  for (std::size_t first = 0; first + size <= rows.size(); first += size) {
    double x = 0, y = 0;
    for (std::size_t i = first; i < first + size; ++i)
      x += std::log10(std::max(rows[i].gap_over_floor, 1e-3)), y += rows[i].named == rows[i].truth && rows[i].verdict == "effects";
    line.x.push_back(x / static_cast<double>(size)), line.y.push_back(y / static_cast<double>(size));
  }
  if (line.x.empty()) return "";
  return figure({.title = "Detection",
                 .x_label = "log10 of the gap over the floor, rms",
                 .y_label = "share of single effects named",
                 .lines = {line}});
}

std::string confusion(const ScoreCard& card) {
  std::set<std::string> said;
  for (const auto& [truth, row] : card.confusion)
    for (const auto& [word, n] : row) said.insert(word);
  std::vector<std::string> header{"truth"};
  header.insert(header.end(), said.begin(), said.end());
  std::vector<std::vector<std::string>> rows;
  for (const auto& [truth, row] : card.confusion) {
    std::vector<std::string> cells{escaped(truth)};
    for (const std::string& word : said) cells.push_back(row.contains(word) ? std::to_string(row.at(word)) : "");
    rows.push_back(cells);
  }
  return html::table(header, rows);
}

}  // namespace

std::string card_text(const ScoreCard& card) {
  std::string text = "score card";
  for (const Line& line : lines_of(card))
    text += "\n  " +
            std::string(line.n == 0 ? "-       "
                        : line.met  ? "ok      "
                                    : "MISSED  ") +
            line.name + ": " + line.value + (line.interval.empty() ? "" : " (" + line.interval + ")") + ", target " + line.target;
  return text + "\n  " + Truth::strengths;
}

std::string bench_page(const std::string& title, const std::vector<ScoreRow>& rows, const ScoreCard& card) {
  std::vector<std::vector<std::string>> table;
  for (const Line& line : lines_of(card))
    table.push_back({escaped(line.name), line.value, line.interval, escaped(line.target),
                     line.n == 0 ? "-"
                     : line.met  ? "<span class=\"pass\">met</span>"
                                 : "<span class=\"fail\">missed</span>"});
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Snag: blind benchmark</title>\n<style>" +
         std::string(report_style) + "</style>\n</head>\n<body>\n<h1>Blind benchmark of the diagnosis: " + escaped(title) +
         "</h1>\n<p class=\"origin\">" + std::to_string(rows.size()) + " sealed sets, by version " + version_number + " (" + version_git +
         ")</p>\n" +
         section("Scores", html::table({"Score", "found", "95 % interval", "target", ""}, table) + "<p>" + Truth::strengths + "</p>") +
         section("Reliability and detection", "<div class=\"plots\">" + reliability(card) + detection(rows) + "</div>") +
         section("What was said of what", confusion(card)) + "</body>\n</html>\n";
}

}  // namespace snag
