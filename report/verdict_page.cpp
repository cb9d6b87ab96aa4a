#include "report/verdict_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "base/version.hpp"
#include "base/words.hpp"
#include "observe/observables.hpp"
#include "report/html.hpp"
#include "report/line_plot.hpp"
#include "report/page.hpp"
#include "report/verdict_maps.hpp"
#include "report/verdict_words.hpp"

namespace snag {

namespace {

struct Bar {
  std::string label, text;
  double length = 0;
  bool strong = false;
};

/// Level bars with their labels on the left and numbers on the right.
std::string bars(const std::vector<Bar>& all) {
  constexpr double width = 760, left = 230, right = 90, height = 24;
  double longest = 0;
  for (const Bar& bar : all) longest = std::max(longest, bar.length);
  std::string svg =
      "<svg viewBox=\"0 0 760 " + std::to_string(static_cast<int>(height * static_cast<double>(all.size()) + 4)) + "\" role=\"img\">\n";
  double y = 2;
  for (const Bar& bar : all) {
    const double length = longest > 0 && std::isfinite(bar.length) ? (width - left - right) * bar.length / longest : 0;
    const std::string middle = number_text(y + 0.66 * height);
    svg += "<text x=\"" + number_text(left - 8) + "\" y=\"" + middle + "\" text-anchor=\"end\">" + escaped(bar.label) +
           "</text><rect x=\"" + number_text(left) + "\" y=\"" + number_text(y + 3) + "\" width=\"" + number_text(length) + "\" height=\"" +
           number_text(height - 6) + "\" fill=\"" + (bar.strong ? "#0072b2" : "#a9b7c6") + "\"/><text x=\"" +
           number_text(left + length + 6) + "\" y=\"" + middle + "\">" + bar.text + "</text>\n";
    y += height;
  }
  return svg + "</svg>\n";
}

std::string which(const Verdict& v) {
  std::vector<std::pair<double, std::string>> sorted;
  for (const auto& [name, p] : v.acts) sorted.emplace_back(p, name);
  for (const char* name : {"none", "outside"}) sorted.emplace_back(v.probability.at(name), name);
  std::sort(sorted.rbegin(), sorted.rend());
  const std::vector<std::string> strong = names_of(v);
  std::vector<Bar> all;
  for (std::size_t i = 0; i < std::min<std::size_t>(sorted.size(), 10); ++i)
    all.push_back({sorted[i].second, probability_in_words(sorted[i].first), sorted[i].first,
                   std::count(strong.begin(), strong.end(), sorted[i].second) > 0});
  return bars(all) +
         "<p>The bar of an effect is the probability that it acts, alone or together with another; blue is what the verdict names. For an "
         "effect that these data cannot "
         "show it is the probability before the data. None: no effect is missing. Outside: the cause is not in the library.</p>\n";
}

std::string strengths(const Verdict& v) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, estimate] : v.parameters)
    rows.push_back(
        {escaped(name) + (estimate.absorbing ? " (far from its physically expected value: it may be compensating for another error)" : ""),
         rounded(estimate.mean) + " ± " + rounded(estimate.sd) + (estimate.unit == "1" ? "" : " " + escaped(estimate.unit)),
         html::number(estimate.cochran_p)});
  return rows.empty() ? "" : html::table({"Strength", "fitted", "p that the points agree on it"}, rows);
}

std::string unit_in_label(const std::string& unit) { return unit == "1" || unit.empty() ? "" : " [" + unit + "]"; }

/// Draws of one variable over another.
std::string pair_plot(const PosteriorDraws::Variable& a, const PosteriorDraws::Variable& b) {
  constexpr std::size_t shown = 500;
  PlotLine draws{.label = "", .x = {}, .y = {}, .scattered = true};
  for (std::size_t i = 0; i < std::min(shown, a.draws.size()); ++i) draws.x.push_back(a.draws[i]), draws.y.push_back(b.draws[i]);
  char correlation[32];
  std::snprintf(correlation, sizeof correlation, "%.2f", correlation_of(a, b));
  const auto label = [](const PosteriorDraws::Variable& v) {
    return v.name + (v.is_strength ? unit_in_label(v.unit) : " [standard uncertainties]");
  };
  return figure({.title = std::string("correlation ") + correlation, .x_label = label(a), .y_label = label(b), .lines = {draws}});
}

/// The strengths against each other, and each against the input that it is confused with most.
std::string pairs_of_strengths(const Verdict& v) {
  std::vector<const PosteriorDraws::Variable*> strengths, inputs;
  for (const PosteriorDraws::Variable& variable : v.posterior.variables) (variable.is_strength ? strengths : inputs).push_back(&variable);
  std::string plots;
  for (std::size_t i = 0; i < strengths.size(); ++i)
    for (std::size_t j = i + 1; j < strengths.size(); ++j) plots += pair_plot(*strengths[i], *strengths[j]);
  constexpr double confused = 0.3;
  for (const PosteriorDraws::Variable* strength : strengths) {
    const auto size = [&](const PosteriorDraws::Variable* input) { return std::abs(correlation_of(*strength, *input)); };
    const auto most = std::max_element(inputs.begin(), inputs.end(), [&](const auto* a, const auto* b) { return size(a) < size(b); });
    if (most != inputs.end() && size(*most) > confused) plots += pair_plot(*strength, **most);
  }
  return plots.empty() ? ""
                       : "<p>Draws from the posterior under " + escaped(v.posterior.hypothesis) +
                             ": strengths against each other and against the most correlated input. posterior.json has "
                             "all of them; arviz.from_json reads it.</p>\n<div class=\"plots\">" +
                             plots + "</div>\n";
}

std::string how_far(const Verdict& v) {
  if (!v.gap.computable)
    return "<p>Not computable: it needs paths or means of scalars at three or more withheld operating points, enough runs in the "
           "budget for the chosen hypothesis there, and none of these runs may fail. The verdict follows from the evidence alone.</p>\n";
  std::string text = bars({{"gap before", html::number(v.gap.before), v.gap.before, false},
                           {"gap after", html::number(v.gap.after), v.gap.after, true},
                           {"noise floor", html::number(v.gap.floor), v.gap.floor, false},
                           {"remainder", html::number(v.gap.remainder), v.gap.remainder, false}});
  const auto row = [](const std::string& name, const Shrinkage& s) {
    return std::vector<std::string>{escaped(name), share_in_words(s.mean),
                                    std::isnan(s.mean) ? "-" : share_in_words(s.low) + " to " + share_in_words(s.high)};
  };
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, s] : v.shrinkage) rows.push_back(row(name, s));
  for (const auto& [name, s] : v.shrinkage_rejected) rows.push_back(row(name + ", rejected", s));
  rows.push_back(row("a correction without physics", v.shrinkage_regression));
  return text +
         "<p>Mean square differences at the withheld points, in units of the uncertainty of the data, minus the part that noise alone "
         "makes "
         "(the noise floor). Remainder: the gap that the best effects leave. A dash: the withheld points show no gap beyond "
         "noise.</p>\n" +
         html::table({"The gap shrinks by adding", "by", "95 % interval"}, rows);
}

/// Sizes of the missing forces over time, place and speed.
std::string missing_force(const Verdict& v) {
  if (v.missing_force.empty()) return "";
  const auto size = [](const std::array<double, 3>& force) {
    double square = 0;
    for (const double one : force) square += std::isnan(one) ? 0 : one * one;
    return std::sqrt(square);
  };
  const bool has_after =
      std::any_of(v.missing_force.begin(), v.missing_force.end(), [&](const MissingForce& f) { return size(f.after) > 0; });
  std::vector<std::pair<std::string, std::function<double(const MissingForce&)>>> over{
      {"t [s]", [](const MissingForce& f) { return f.time; }}};
  for (std::size_t d = 0; d < 3; ++d)
    if (!std::isnan(v.missing_force.front().place.at(d)))
      over.emplace_back("measured " + std::string(1, "xyz"[d]) + " [m]", [d](const MissingForce& f) { return f.place.at(d); });
  over.emplace_back("speed [m/s]", [](const MissingForce& f) { return f.speed; });
  std::string plots;
  for (const auto& [label, x] : over) {
    LinePlot plot{.title = "Missing force over " + label.substr(0, label.find(" [")),
                  .x_label = label,
                  .y_label = "force over mass [N/kg]",
                  .lines = {}};
    PlotLine before{.label = "base model, inputs fitted", .x = {}, .y = {}, .scattered = true}, after = before, u = before;
    after.label = "with " + effects_in_words(v), u.label = "standard uncertainty";
    for (const MissingForce& f : v.missing_force) {
      for (PlotLine* line : {&before, &after, &u}) line->x.push_back(x(f));
      before.y.push_back(size(f.before)), after.y.push_back(size(f.after)), u.y.push_back(size(f.u));
    }
    plot.lines = {before};
    if (has_after) plot.lines.push_back(after);
    plot.lines.push_back(u);
    plots += figure(plot);
  }
  return "<p>The force that is missing at all points, over the mass that it moves: the mean missing acceleration in parts of the measured "
         "paths, with the inputs as fitted.</p>\n<div class=\"plots\">" +
         plots + "</div>\n";
}

/// What a cell is to the others.
std::string remark_on(const GapCell& cell) {
  std::string remark;
  if (cell.onset) remark += "begins here ";
  if (cell.origin != GapOrigin::not_judged)
    remark += std::string(cell.origin == GapOrigin::born ? "born here" : word(cell.origin)) +
              " (restarted: " + html::number(cell.restart_z) + ") ";
  if (cell.blind && !cell.significant) remark += "blind ";
  return remark + (cell.withheld ? "withheld" : "");
}

/// Data and simulation of the paths that differ most: as they are, and beside it what is left of the measured values.
std::string curves(const Verdict& v) {
  std::string plots;
  const std::string with = (v.verdict == VerdictKind::outside ? "in part: with " : "with ") + effects_in_words(v) + ", inputs fitted";
  for (const GapCurve& c : v.curves) {
    const auto less_measured = [&](std::vector<double> values) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] -= c.measured[i];
      return values;
    };
    const std::string title = c.observable + " at " + c.point, label = c.observable + (c.unit == "1" ? "" : " [" + c.unit + "]");
    LinePlot path{.title = title, .x_label = "t [s]", .y_label = label, .lines = {}}, rest = path;
    rest.title += ": simulated minus measured", rest.y_label = "difference of " + label;
    path.lines = {{.label = "measured", .x = c.time, .y = c.measured, .dotted = true}, {.label = "base model", .x = c.time, .y = c.base}};
    const std::vector<double> zero(c.time.size(), 0.0);
    rest.lines = {{.label = "measured", .x = c.time, .y = zero, .dotted = true},
                  {.label = "base model", .x = c.time, .y = less_measured(c.base)}};
    if (!c.with_effect.empty()) {
      path.lines.push_back({.label = with, .x = c.time, .y = c.with_effect});
      rest.lines.push_back({.label = with, .x = c.time, .y = less_measured(c.with_effect)});
    }
    for (LinePlot* plot : {&path, &rest}) {
      PlotBand band{.label = "measured ± 2 u", .x = c.time, .low = plot->lines.front().y, .high = plot->lines.front().y};
      for (std::size_t i = 0; i < c.u.size(); ++i) band.low[i] -= 2 * c.u[i], band.high[i] += 2 * c.u[i];
      plot->bands = {band};
      plots += figure(*plot);
    }
  }
  return plots.empty() ? ""
                       : "<p>The paths that differ most. u: standard uncertainty of the measured mean from noise, scatter and bias; the "
                         "uncertainty of the inputs of the base model is not included.</p>\n<div class=\"plots\">" +
                             plots + "</div>\n";
}

std::string number_or_dash(double value) { return std::isnan(value) ? "-" : html::number(value); }

std::string where(const Verdict& v) {
  std::vector<const GapCell*> cells;
  for (const GapCell& cell : v.where) cells.push_back(&cell);
  std::stable_sort(cells.begin(), cells.end(), [](const GapCell* a, const GapCell* b) { return std::abs(a->score) > std::abs(b->score); });
  constexpr std::size_t shown = 8;
  std::vector<std::vector<std::string>> rows, more;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const GapCell& c = *cells[i];
    (i < shown ? rows : more)
        .push_back({escaped(c.observable + (c.region == "all" ? "" : ", " + c.region) + " at " + c.point + ", " + window_in_words(c)),
                    number_or_dash(c.measured), number_or_dash(c.simulated), number_or_dash(c.u_val), number_or_dash(c.z),
                    (c.significant ? "<span class=\"fail\">" : "<span class=\"idle\">") + html::number(c.score) + "</span>",
                    number_or_dash(c.score_after), remark_on(c)});
  }
  const std::vector<std::string> header{"Cell",         "measured (SI)", "simulated",   "u of the difference",
                                        "difference/u", "score",         "score after", ""};
  const auto n = std::count_if(v.where.begin(), v.where.end(), [](const GapCell& c) { return c.significant; });
  const bool has_after = std::any_of(v.where.begin(), v.where.end(), [](const GapCell& c) { return !std::isnan(c.score_after); });
  return "<p>" + std::to_string(n) + " of " + std::to_string(v.where.size()) +
         " cells differ beyond what their uncertainty explains (false discovery rate 0.05). Colour and number: the normal score of the "
         "best "
         "test of a cell; one column for each point. The tests are: the mean difference over its uncertainty, all rows of the cell with "
         "the "
         "inputs as fitted, and what the effects would add there. A run is started again from the measured state at the beginning of each "
         "part: if it differs again, a gap begins in that part (framed: born here); if it agrees, the gap is inherited from an earlier "
         "part.</p>\n" +
         map_of_gap(v, &GapCell::score) +
         (has_after ? "<p>What is left with " + escaped(effects_in_words(v)) + ", strengths and inputs fitted.</p>\n" +
                          map_of_gap(v, &GapCell::score_after)
                    : "") +
         map_of_ways(v) + missing_force(v) + curves(v) + html::table(header, rows) +
         (more.empty() ? "" : "<details><summary>The other cells</summary>\n" + html::table(header, more) + "</details>\n");
}

std::string evidence(const Verdict& v) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, nats] : v.log_evidence) {
    const auto left_out = v.leave_one_out.find(name);
    const auto p = v.probability.find(name);
    rows.push_back({escaped(name), html::number(nats), left_out == v.leave_one_out.end() ? "" : html::number(left_out->second),
                    p == v.probability.end() ? "" : probability_in_words(p->second)});
  }
  std::string text = html::table({"Hypothesis", "evidence over none, nats", "points left out one by one, nats", "probability"}, rows);
  rows.clear();
  for (const PredictiveCheck& check : v.checks) rows.push_back({escaped(check.name), html::number(check.value), html::number(check.p)});
  if (!rows.empty()) text += html::table({"Does the first hypothesis explain the data?", "value", "p"}, rows);
  if (!v.improved.why_none.empty()) text += "<p>No case_with_effects.toml: " + escaped(v.improved.why_none) + "</p>\n";
  for (const std::string& note : v.notes) text += "<p>" + escaped(note) + "</p>\n";
  return text + "<p>" + std::to_string(v.runs) + " runs. Data sha256 " + v.data_sha256 + ".</p>\n";
}

std::string next(const Verdict& v) {
  std::string text;
  for (const auto& tie : v.identifiability.ties)
    text += "<p>These effects have the same signature in this experiment: " + escaped(joined(tie)) + ".</p>\n";
  // A cause that is attributed needs no more repeats.
  if (!v.identifiability.next_experiment.empty() && v.wording != Wording::attributed)
    text += "<p>" + escaped(v.identifiability.next_experiment) + "</p>\n";
  std::vector<std::vector<std::string>> conditions;
  for (const NewCondition& c : v.identifiability.new_conditions)
    conditions.push_back({escaped(condition_in_words(c)), escaped(c.observable), html::number(c.nats), html::number(c.cost),
                          html::number(c.nats_of_repeat)});
  if (!conditions.empty())
    text +=
        "<p>Conditions that were not measured, and the evidence (nats) that one test there is expected to give between the two most "
        "probable hypotheses:</p>\n" +
        html::table({"Condition", "observable", "nats", "cost, repeats", "of one more repeat, nats"}, conditions);
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, d] : v.identifiability.detectability) rows.push_back({escaped(name), html::number(d), d < 3 ? "blind" : ""});
  return text + (rows.empty() ? "" : html::table({"Effect at its expected strength", "signal over uncertainty", ""}, rows));
}

}  // namespace

std::string verdict_page(const Verdict& v) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Snag: " +
      escaped(v.name) + "</title>\n<style>" + std::string(report_style) + "</style>\n</head>\n<body>\n<h1>" + escaped(v.name) +
      "</h1>\n<p class=\"origin\">Diagnosis of the gap between simulation and measurement, by version " + version_number + " (" +
      version_git + ")</p>\n<p class=\"outcome\">" + escaped(verdict_sentence(v)) + "</p>\n<p>" + escaped(verdict_advice(v)) + "</p>\n";
  page += section("Which effect", which(v) + strengths(v) + pairs_of_strengths(v));
  page += section("How far the gap shrinks", how_far(v));
  page += section("Where the gap is", where(v));
  page += section("What to measure next", next(v));
  page += section("The evidence", evidence(v));
  return page + "</body>\n</html>\n";
}

}  // namespace snag
