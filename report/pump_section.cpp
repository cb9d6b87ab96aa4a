#include "report/pump_section.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/series.hpp"
#include "base/words.hpp"
#include "report/html.hpp"
#include "report/line_plot.hpp"
#include "report/monitor_plots.hpp"
#include "report/results.hpp"

namespace snag {

namespace {

constexpr int n_shown = 5;  // revolutions in a plot over the angle

/// What a column of revolutions.csv is in words, with the places of its number: "mean of the head [m]".
struct Row {
  const char* meaning;
  const char* column;
  const char* unit;
  double factor = 1;
};

std::string revolution_table(const SeriesTable& revolutions) {
  const std::vector<Row> rows = {{"Flow rate out of the outlet", "flow_out", "L/s", 1e3},
                                 {"Flow rate into the inlet", "flow_in", "L/s", 1e3},
                                 {"Head", "head", "m"},
                                 {"Head of the total pressure, weighted with the flux", "head_total", "m"},
                                 {"Lowest head", "head_min", "m"},
                                 {"Highest head", "head_max", "m"},
                                 {"Broadband head fluctuation (beyond 20 shaft harmonics), rms", "head_noise", "m"},
                                 {"Torque of the water on the impeller", "torque", "N m"},
                                 {"pressure part", "torque_pressure", "N m"},
                                 {"viscous part", "torque_friction", "N m"},
                                 {"Lowest torque", "torque_min", "N m"},
                                 {"Highest torque", "torque_max", "N m"},
                                 {"Shaft power", "shaft_power", "W"},
                                 {"Hydraulic power", "hydraulic_power", "W"},
                                 {"Efficiency", "efficiency", "%", 100}};
  std::vector<std::vector<std::string>> table;
  const std::size_t n = revolutions.values[0].size();
  const auto cell = [&](const Row& row, std::size_t i) {
    return html::number(row.factor * revolutions.column(row.column)[i]) + " " + row.unit;
  };
  for (const Row& row : rows) {
    table.push_back({row.meaning, cell(row, n - 1)});
    if (n > 1) table.back().push_back(cell(row, n - 2));
  }
  const auto title = [&](std::size_t i) { return "Revolution " + html::number(revolutions.column("revolution")[i]); };
  std::vector<std::string> header{"Per-revolution mean, unless stated otherwise", title(n - 1)};
  if (n > 1) header.push_back(title(n - 2));
  return html::table(header, table);
}

std::string harmonics_table(const SeriesTable& revolutions) {
  std::vector<std::vector<std::string>> table;
  const auto last = [&](const std::string& column) { return html::number(revolutions.column(column).back()); };
  for (const char* n : {"1", "2", "3"})
    table.push_back({n, last(std::string("head_harmonic_") + n) + " m", last(std::string("head_phase_") + n) + "°",
                     last(std::string("torque_harmonic_") + n) + " N m", last(std::string("torque_phase_") + n) + "°"});
  return html::table({"Harmonic of the shaft", "Head, amplitude", "Head, phase", "Torque, amplitude", "Torque, phase"}, table) +
         "<p>A harmonic n with amplitude A and phase φ is A cos(n θ − φ), with the angle θ of the rotor in the frame of the casing.</p>\n";
}

/// How far the last revolution is from the one before it.
std::string settled(const SeriesTable& revolutions) {
  if (revolutions.values[0].size() < 2) return "<p>One revolution: whether the flow has settled is not known.</p>\n";
  const auto percent = [&](const char* column) { return html::number(100 * revolutions.column(column).back()) + " %"; };
  return "<p>From the revolution before to the last one the mean head changed by " + percent("head_change_rel") + ", the mean torque by " +
         percent("torque_change_rel") + ".</p>\n";
}

/// A quantity over the angle, the last complete revolution before the fainter ones before it.
std::string over_angle(const SeriesTable& instants, const std::string& title, const char* column, const char* label) {
  const std::vector<double>&turned = instants.column("revolutions"), &angle = instants.column("angle"), &value = instants.column(column);
  const int last = static_cast<int>(std::floor(turned.back() + 1e-9));  // complete ones
  LinePlot plot{title, "angle of the rotor [deg]", label, {}};
  plot.x_ticks = angle_ticks;
  const int first = last > 1 ? 2 : 1;  // the start from rest would hide the rest
  for (int revolution = std::max(first, last - n_shown + 1); revolution <= std::max(1, last); ++revolution) {
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < turned.size(); ++i)
      if (turned[i] > revolution - 1 + 1e-9 && turned[i] <= revolution + 1e-9) points.emplace_back(angle[i], value[i]);
    std::sort(points.begin(), points.end());
    PlotLine line;
    for (const auto& [x, y] : points) line.x.push_back(x), line.y.push_back(y);
    line.faint = revolution < last;
    line.label = "revolution " + std::to_string(revolution);
    plot.lines.push_back(std::move(line));
  }
  return figure(plot);
}

std::string scatter(const SeriesTable& phase, const std::string& title, const std::string& quantity, const char* label) {
  const std::vector<double>&mean = phase.column(quantity + "_mean"), &deviation = phase.column(quantity + "_deviation");
  LinePlot plot{title, "angle of the rotor [deg]", label, {}};
  plot.x_ticks = angle_ticks;
  for (const int sign : {-1, 1, 0}) {
    PlotLine line{sign ? (sign > 0 ? "plus" : "minus") + std::string(" one standard deviation") : "mean", phase.values[0], {}};
    for (std::size_t i = 0; i < mean.size(); ++i) line.y.push_back(mean[i] + sign * deviation[i]);
    line.faint = sign != 0;
    plot.lines.push_back(std::move(line));
  }
  return figure(plot);
}

std::string over_revolutions(const SeriesTable& revolutions, const std::string& title, const char* column, const char* label) {
  std::vector<double> number = revolutions.column("revolution"), value = revolutions.column(column);
  if (number.size() > 2) number.erase(number.begin()), value.erase(value.begin());  // the start from rest
  PlotLine line{"", number, value};
  line.dotted = true;
  return figure({title, "revolution", label, {line}});
}

}  // namespace

std::string pump_section(const nlohmann::json& summary, const std::filesystem::path& monitors) {
  std::string content = pump_table(summary);
  try {
    const SeriesTable instants = recorded(monitors / "pump.csv"), revolutions = recorded(monitors / "revolutions.csv"),
                      phase = recorded(monitors / "phase.csv");
    if (instants.columns.empty()) return content;
    if (!revolutions.columns.empty()) content += settled(revolutions) + revolution_table(revolutions) + harmonics_table(revolutions);
    std::string plots = over_angle(instants, "Head over the angle", "head", "head [m]") +
                        over_angle(instants, "Torque over the angle", "torque", "torque [N m]");
    if (!phase.columns.empty() && phase.column("revolutions")[0] > 1)
      plots += scatter(phase, "Head at each angle, over all revolutions after the start-up", "head", "head [m]") +
               scatter(phase, "Torque at each angle, over all revolutions after the start-up", "torque", "torque [N m]");
    if (!revolutions.columns.empty() && revolutions.values[0].size() > 1)
      plots += over_revolutions(revolutions, "Mean head of each revolution", "head", "head [m]") +
               over_revolutions(revolutions, "Efficiency of each revolution", "efficiency", "efficiency");
    content += "<div class=\"plots\">\n" + plots + "</div>\n";
  } catch (const Error& error) {
    content += "<p class=\"problem\">" + escaped(error.what()) + "</p>\n";
  }
  return content;
}

}  // namespace snag
