#include "report/bench_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/version.hpp"
#include "base/words.hpp"
#include "report/html.hpp"
#include "report/line_plot.hpp"
#include "report/page.hpp"

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
    lines.push_back({m.name, (std::isfinite(m.value) ? share_text(m.value) + " over " : "not found in ") + std::to_string(m.n) + " sets",
                     "", m.target, m.n, m.met()});
  return lines;
}

std::string reliability(const ScoreCard& card) {
  LinePlot plot{.title = "Reliability",
                .x_label = "probability stated for the first hypothesis",
                .y_label = "share of them that was right",
                .lines = {}};
  PlotLine line{.label = "sets whose stated probability is in the same tenth", .x = {}, .y = {}, .dotted = true};
  for (const auto& bin : card.reliability)
    if (bin.n > 0) line.x.push_back(bin.stated), line.y.push_back(bin.right);
  plot.lines = {line, {.label = "ideal", .x = {0, 1}, .y = {0, 1}, .faint = true}};
  return figure(plot);
}

/// How many sets each dot of the reliability stands on.
std::string bins(const ScoreCard& card) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& bin : card.reliability)
    if (bin.n > 0) rows.push_back({share_text(bin.stated), share_text(bin.right), std::to_string(bin.n)});
  return html::table({"Probability stated, mean", "share that was right", "sets"}, rows) +
         "<p>A diagnosis whose probabilities are exactly right would show a calibration error of " + share_text(card.ece_by_chance) +
         " on average, because each dot has a few sets only.</p>\n";
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
      x += std::log10(std::max(rows[i].gap_over_floor, 1e-3)),
          y += rows[i].named == rows[i].truth && rows[i].verdict == VerdictKind::effects;
    line.x.push_back(x / static_cast<double>(size)), line.y.push_back(y / static_cast<double>(size));
  }
  if (line.x.empty()) return "";
  return figure({.title = "Detection",
                 .x_label = "size of the gap over noise and inputs (rms), power of ten",
                 .y_label = "share of single effects named rightly",
                 .lines = {line}});
}

/// What was said of each truth, the right words first.
std::string confusion(const ScoreCard& card) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [truth, said] : card.confusion) {
    int n = 0, right = 0;
    std::string words_of_right, others;
    for (const auto& [word, count] : said) {
      n += count;
      const std::string text = std::string(word == truth ? "<span class=\"pass\">" : "<span class=\"idle\">") + escaped(word) + "</span>" +
                               (count > 1 ? " (" + std::to_string(count) + ")" : "");
      std::string& list = word == truth ? words_of_right : others;
      list += (list.empty() ? "" : ", ") + text;
      if (word == truth) right = count;
    }
    rows.push_back({escaped(truth), std::to_string(right) + " of " + std::to_string(n),
                    words_of_right + (words_of_right.empty() || others.empty() ? "" : ", ") + others});
  }
  return html::table({"Truth", "right", "what was said"}, rows);
}

constexpr const char* meaning =
    "<p>Each set is a synthetic experiment whose truth was stored before the diagnosis read its data. Null: no effect is missing. Outside: "
    "the cause is not in the library of effects. Detectable: the effect differs from the base model (each effect of a pair from the other "
    "alone) by 3 standard uncertainties or more, for any values of the uncertain inputs. Sets that can be distinguished: null and "
    "detectable "
    "ones.</p>\n";

constexpr const char* of_intervals =
    "<p>No gap shrinks by more than 100 %, so an interval can miss the ideal on one side only: correct intervals contain it in 97.5 % of "
    "the sets.</p>\n";

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
         section("Scores", meaning + html::table({"Score", "found", "95 % interval", "target", ""}, table) + of_intervals + "<p>" +
                               Truth::strengths + "</p>") +
         section("Reliability and detection", "<div class=\"plots\">" + reliability(card) + detection(rows) + "</div>" + bins(card)) +
         section("What was said of what", confusion(card)) + "</body>\n</html>\n";
}

}  // namespace snag
