#include "report/passage_section.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "observe/outcome.hpp"
#include "observe/passage/passage_geometry.hpp"
#include "report/html.hpp"
#include "report/line_plot.hpp"

namespace snag {

namespace {

using nlohmann::json;

constexpr std::size_t most_marks = 12;  // events in a plot

double real(const json& table, const char* key) {
  return table.is_object() && table.contains(key) && table[key].is_number() ? table[key].get<double>() : NAN;
}

/// Two or three significant digits: what a sentence bears.
std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) < 0.1 ? "%.2g" : "%.3g", value);
  return text;
}

/// Of a percentage whose parts are means of a swinging quantity.
std::string brief_percent(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", value);
  return text;
}

std::string name_of(const RagPassage& passage, bool is_alone) {
  if (is_alone) return "The rag";
  const auto& name = passage.summary;
  return name.is_object() && name.contains("name") && name["name"].is_string() ? escaped(name["name"].get<std::string>())
                                                                               : "Rag number " + std::to_string(passage.id);
}

/// How it ended, as the beginning of a sentence.
std::string ending(const RagPassage& passage, const std::string& name) {
  const std::string outcome = passage.summary.is_object() && passage.summary.contains("outcome") && passage.summary["outcome"].is_string()
                                  ? passage.summary["outcome"].get<std::string>()
                                  : "";
  const double retention = real(passage.summary, "retention_time_s");
  const std::optional<Outcome> known = outcome_named(outcome);
  if (!known) return outcome.empty() ? name + " has no outcome yet" : name + " ended as \"" + escaped(outcome) + "\"";
  const std::string ended = name + " " + words_of(*known).at_the_end, at_the_end = " when the run ended";
  if (known == Outcome::exited) return ended + (std::isfinite(retention) ? " " + brief(retention) + " s after it had wholly entered" : "");
  if (known == Outcome::upstream) return (std::isfinite(passage.entered) ? ended : name + " had not reached the pump") + at_the_end;
  const double inside = passage.way.values[0].back() - passage.wholly_in;
  return ended + at_the_end + (std::isfinite(inside) ? ", " + brief(inside) + " s after it had wholly entered" : "");
}

std::string touch(const RagPassage& passage) {
  const double impeller = passage.touching_impeller, tongue = passage.touching_tongue;
  if (impeller == 0 && tongue == 0) return "it touched neither impeller nor tongue";
  if (impeller == 0) return "it touched the tongue for " + brief(tongue) + " s and never the impeller";
  return "it touched the impeller for " + brief(impeller) + " s and the tongue " +
         (tongue > 0 ? "for " + brief(tongue) + " s" : std::string("never"));
}

/// When the rag had left, or the end of the run.
double left(const RagPassage& passage) { return std::isfinite(passage.exited) ? passage.exited : passage.way.values[0].back(); }

/// "the head fell by 3 % while it passed", "" where it cannot be told.
std::string head_change(const RagPassage& passage, const PumpRecord& pump) {
  const PumpPassage around = pump.passage(passage.entered, passage.exited);
  if (!around.change(&PumpMeans::head) || around.before->head <= 0) return "";
  const double change = 100 * *around.change(&PumpMeans::head);
  const std::string when = std::isfinite(passage.exited) ? " while it passed" : " from its entering on";
  if (std::abs(change) < 0.05) return "the head stayed as it was" + when;
  return std::string("the head ") + (change < 0 ? "fell" : "rose") + " by " + brief_percent(std::abs(change)) + when;
}

/// Sentences with a capital from clauses of the same subject.
std::string sentence(std::vector<std::string> clauses) {
  std::erase(clauses, "");
  std::string text;
  for (std::size_t i = 0; i < clauses.size(); ++i) text += (i == 0 ? "" : "; ") + clauses[i];
  return text + ".";
}

std::string verdict(const RagPassage& passage, const PumpRecord& pump, bool is_alone) {
  std::vector<std::string> clauses = {ending(passage, name_of(passage, is_alone))};
  if (const double entering = real(passage.summary, "time_to_enter_s"); std::isfinite(entering))
    clauses.push_back("it took " + brief(entering) + " s to enter");
  clauses.push_back(touch(passage));
  if (const double rounds = real(passage.summary, "recirculations"); rounds > 0)
    clauses.push_back("it was carried past the tongue back into the volute " + (rounds == 1 ? "once" : brief(rounds) + " times"));
  for (const auto& [key, place] : {std::pair{"stuck_on_tongue_s", "tongue"}, {"stuck_on_impeller_s", "impeller"}})
    if (const double stuck = real(passage.summary, key); stuck > 0)
      clauses.push_back("it hung on the " + std::string(place) + " for " + brief(stuck) + " s");
  clauses.push_back(head_change(passage, pump));
  if (const double broken = real(passage.summary, "broken_bonds"); broken > 0)
    clauses.push_back(html::count(std::llround(broken)) + " of its bonds broke");
  return sentence(clauses);
}

/// Radii about the shaft, m; NAN where the case does not say.
struct Radii {
  double impeller = NAN, tongue = NAN;
};

Radii radii_of(const std::string& case_text) {
  Radii radii;
  try {
    const Table root = CaseFile::parse(case_text).root();
    const Table passage = root.table(PassageSettings().section());
    if (!passage.present()) return radii;
    Vec3 origin, axis{0, 0, 1}, tongue;
    root.table("rotating_zone").read({{"origin", &origin, "m"}, {"axis", &axis}});
    passage.read({{"impeller_radius", &radii.impeller, "m"}, {"tongue", &tongue, "m"}});
    axis = unit(axis);
    const Vec3 away = tongue - origin;
    radii.tongue = norm(away - dot(away, axis) * axis);
  } catch (const Error&) {  // a case of another version: the plot goes without these lines
  }
  return radii;
}

void mark_passage(LinePlot& plot, const RagPassage& passage) {
  if (std::isfinite(passage.wholly_in)) {
    if (passage.entered < passage.wholly_in) plot.spans.push_back({passage.entered, passage.wholly_in, "entering"});
    plot.spans.push_back({passage.wholly_in, left(passage), "wholly in the pump, or leaving it"});
  } else if (std::isfinite(passage.entered)) {
    plot.spans.push_back({passage.entered, left(passage), "entering"});
  }
  for (std::size_t i = 0; i < std::min(most_marks, passage.events.size()); ++i) plot.marks.push_back({passage.events[i].time, ""});
}

/// The letters that all plots share.
std::string letters(const RagPassage& passage) {
  if (passage.events.empty()) return "";
  std::string text;
  for (std::size_t i = 0; i < std::min(most_marks, passage.events.size()); ++i)
    text += (i == 0 ? "" : "; ") + ("<b>" + mark_letter(i) + "</b> " + escaped(passage.events[i].what)) + ", " +
            html::number(passage.events[i].time) + " s";
  if (passage.events.size() > most_marks)
    text += "; the other " + std::to_string(passage.events.size() - most_marks) + " events stand in the table of the rag";
  return "<p>Letters in the plots: " + text + ".</p>\n";
}

std::string pump_plot(const RagPassage& passage, const PumpRecord& pump, const std::string& title, const char* column, const char* label) {
  const double room = 3 * pump.period();
  double begin = std::isfinite(passage.entered) ? passage.entered - room : -infinity, end = left(passage) + room;
  if (pump.time().back() > 2 * pump.period()) begin = std::max(begin, pump.time().front() + pump.period());  // the start hides the rest
  if (!(begin < end)) begin = -infinity, end = infinity;
  const auto& value = pump.column(column);
  const auto mean = pump.sliding_mean(column);
  PlotLine each{"each instant", {}, {}}, sliding{"mean over the revolution around it", {}, {}};
  each.faint = true;
  for (std::size_t i = 0; i < pump.time().size(); ++i) {
    const double t = pump.time()[i];
    if (t < begin || t > end) continue;
    each.x.push_back(t), each.y.push_back(value[i]);
    if (std::isfinite(mean[i])) sliding.x.push_back(t), sliding.y.push_back(mean[i]);
  }
  LinePlot plot{title, "time [s]", label, {each}};
  if (!sliding.x.empty()) plot.lines.push_back(sliding);
  mark_passage(plot, passage);
  return figure(plot);
}

std::string pump_table(const RagPassage& passage, const PumpRecord& pump) {
  const PumpPassage around = pump.passage(passage.entered, passage.exited);
  const auto means_of = {&around.before, &around.passing, &around.after};
  if (!around.before && !around.passing) return "";
  std::vector<std::vector<std::string>> rows = {{"Revolutions that the mean is over"}};
  for (const auto* means : means_of) rows[0].push_back(*means ? std::to_string((*means)->revolutions) : "none");
  rows[0].emplace_back();
  const auto add = [&](const char* meaning, const char* unit_, double PumpMeans::*value) {
    rows.push_back({meaning});
    for (const auto* means : means_of) rows.back().push_back(*means ? html::number((**means).*value) + " " + unit_ : "not known");
    const auto change = around.change(value);
    rows.back().push_back(change ? html::number(100 * *change) + " %" : "");
  };
  add("Head", "m", &PumpMeans::head);
  add("Torque of the water on the impeller", "N m", &PumpMeans::torque);
  add("Shaft power", "W", &PumpMeans::shaft_power);
  return html::table({"Mean over whole revolutions", "before", "passing", "after", "change"}, rows);
}

/// The rag's distance from the shaft over the angle of the volute, a line for each turn; 20-degree means from summary.json.
std::string path_plot(const RagPassage& passage, const Radii& radii) {
  const auto &angle = passage.way.column("angle"), &radius = passage.way.column("radius"),
             &inside = passage.way.column("particles_in_casing"), &upstream = passage.way.column("particles_upstream"),
             &out = passage.way.column("particles_out");
  LinePlot plot{
      "Path over the angle of the volute", "angle of the rag's centroid, 0 at the tongue [deg]", "distance from the shaft [mm]", {}};
  plot.x_ticks = angle_ticks;
  bool is_open = false;
  double last = 0;
  for (std::size_t i = 0; i < angle.size(); ++i) {
    if (inside[i] < upstream[i] + out[i] || inside[i] == 0) {  // on its way through a pipe an angle says nothing
      is_open = false;
      continue;
    }
    const double turn = std::floor(angle[i] / 360);
    if (!is_open || turn != last) {
      PlotLine line{"centroid", {}, {}};
      line.continues = !plot.lines.empty();
      plot.lines.push_back(line);
    }
    is_open = true, last = turn;
    plot.lines.back().x.push_back(angle[i] - 360 * turn);
    plot.lines.back().y.push_back(1e3 * radius[i]);
  }
  if (plot.lines.empty()) return "";
  if (passage.summary.is_object() && passage.summary.contains("volute") && passage.summary["volute"].is_array()) {
    PlotLine means{"mean of 20 degrees", {}, {}};
    means.dotted = true;
    for (const json& bin : passage.summary["volute"])
      if (std::isfinite(real(bin, "mean_radius_m")))
        means.x.push_back(real(bin, "angle_deg")), means.y.push_back(1e3 * real(bin, "mean_radius_m"));
    if (!means.x.empty()) plot.lines.push_back(means);
  }
  if (std::isfinite(radii.impeller)) plot.marks.push_back({1e3 * radii.impeller, "edge of the impeller", true});
  if (std::isfinite(radii.tongue)) plot.marks.push_back({1e3 * radii.tongue, "tongue", true});
  return figure(plot);
}

/// Columns of passage.csv over time, with the events.
std::string way_plot(const RagPassage& passage, const std::string& title, const std::string& label,
                     const std::vector<std::pair<const char*, const char*>>& columns) {
  LinePlot plot{title, "time [s]", label, {}};
  for (const auto& [column, words] : columns) plot.lines.push_back({words, passage.way.values[0], passage.way.column(column)});
  mark_passage(plot, passage);
  return figure(plot);
}

/// The stretches of a line in which `present` is above zero.
void add_pieces(LinePlot& plot, const std::string& label, const std::vector<double>& x, const std::vector<double>& y,
                const std::vector<double>& present) {
  const std::size_t first = plot.lines.size();
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(present[i] > 0)) continue;
    if (plot.lines.size() == first || !(present[i - 1] > 0)) {
      plot.lines.push_back({label, {}, {}});
      plot.lines.back().continues = plot.lines.size() > first + 1;
    }
    plot.lines.back().x.push_back(x[i]), plot.lines.back().y.push_back(y[i]);
  }
}

std::string force_plot(const RagPassage& passage, const std::string& title, const std::string& kind) {
  const auto& time = passage.forces.values[0];
  const auto of = [&](const char* which) -> const std::vector<double>& { return passage.forces.column(kind + "_" + which); };
  LinePlot plot{title, "time [s]", "force on a particle [N]", {}};
  add_pieces(plot, "median", time, of("p50"), of("max"));
  add_pieces(plot, "mean", time, of("mean"), of("max"));
  plot.bands = {{"from the median to what 90 % stay below", time, of("p50"), of("p90")},
                {"99 %", time, of("p90"), of("p99")},
                {"the largest", time, of("p99"), of("max")}};
  plot.logarithmic = *std::max_element(of("max").begin(), of("max").end()) > 0;
  mark_passage(plot, passage);
  return figure(plot);
}

std::string tension_words(const RagPassage& passage) {
  const auto& tension = passage.way.column("max_tension");
  const auto i = std::max_element(tension.begin(), tension.end()) - tension.begin();
  if (!(tension[i] > 0)) return "";
  const auto at = [&](const char* column) { return passage.way.column(column)[i]; };
  return "<p>The largest tension of a bond was " + html::number(tension[i]) + " N, at " + html::number(passage.way.values[0][i]) +
         " s at (x, y, z) = (" + html::number(at("max_tension_x")) + ", " + html::number(at("max_tension_y")) + ", " +
         html::number(at("max_tension_z")) + ") m.</p>\n";
}

std::string section_of(const RagPassage& passage, const PumpRecord& pump, const Radii& radii) {
  std::string content, plots = path_plot(passage, radii);
  if (!pump.empty()) {
    content += pump_table(passage, pump);
    plots += pump_plot(passage, pump, "Head of the pump as the rag passes", "head", "head [m]") +
             pump_plot(passage, pump, "Torque of the water on the impeller as the rag passes", "torque", "torque [N m]");
  }
  plots += way_plot(passage, "Particles that touch a wall", "particles",
                    {{"touching_impeller", "impeller"}, {"touching_tongue", "tongue"}, {"touching_other_wall", "other walls"}});
  if (!passage.forces.columns.empty()) {
    plots += force_plot(passage, "Force of the water on a particle", "fluid");
    plots += force_plot(passage, "Contact force on a particle that touches something", "contact");
    LinePlot touching{"Particles that touch something, the rag itself included",
                      "time [s]",
                      "particles",
                      {{"", passage.forces.values[0], passage.forces.column("in_contact")}}};
    mark_passage(touching, passage);
    plots += figure(touching);
  }
  plots += way_plot(passage, "Where the rag's particles are", "particles",
                    {{"particles_upstream", "upstream"}, {"particles_in_casing", "in the pump"}, {"particles_out", "out"}});
  plots += way_plot(passage, "Centroid of the rag", "[m]", {{"radius", "distance from the shaft"}, {"height", "height along the shaft"}});
  plots += way_plot(passage, "Largest tension of a bond", "tension [N]", {{"max_tension", ""}});
  content += tension_words(passage) + letters(passage) + "<div class=\"plots\">\n" + plots + "</div>\n";
  return content;
}

}  // namespace

std::string passage_verdict(const std::vector<RagPassage>& passages, const PumpRecord& pump) {
  std::string text;
  for (const RagPassage& passage : passages) text += (text.empty() ? "" : " ") + verdict(passage, pump, passages.size() == 1);
  return text;
}

std::string passage_section(const std::vector<RagPassage>& passages, const PumpRecord& pump, const std::string& case_text) {
  const Radii radii = radii_of(case_text);
  std::string content;
  for (const RagPassage& passage : passages) {
    std::string own = section_of(passage, pump, radii);
    if (passages.size() == 1) return own;
    content += "<details" + std::string(content.empty() ? " open" : "") + "><summary>" + name_of(passage, false) + "</summary>\n" + own +
               "</details>\n";
  }
  return content;
}

ColumnsByMonitor passage_columns() {
  return {{"passage",
           {"angle", "radius", "height", "particles_upstream", "particles_in_casing", "particles_out", "touching_impeller",
            "touching_tongue", "touching_other_wall", "max_tension"}},
          {"rag_forces",
           {"fluid_mean", "fluid_p50", "fluid_p90", "fluid_p99", "fluid_max", "contact_mean", "contact_p50", "contact_p90", "contact_p99",
            "contact_max", "in_contact"}},
          {"rags", {"particles_out", "bond_tension_max"}}};  // the same as in passage.csv
}

}  // namespace snag
